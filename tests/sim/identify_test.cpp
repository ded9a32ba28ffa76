#include "bringup/identify/identify.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <functional>
#include <string>

#include "bringup/identify/constants_table.h"
#include "bringup/identify/excitation.h"
#include "bringup/identify/record_motion.h"
#include "bringup/identify/simulated_bench.h"
#include "support/identified_arm.h"
#include "support/refuses.h"

namespace thimble::app {
namespace {

using support::hidden_arm;
using support::HiddenArm;
using support::identified;
using support::is_long;
using support::kKnownMass;
using support::Score;

TEST(Identify, FindsTheConstantsOfHiddenArms) {
  const int arms = is_long() ? 200 : 3;
  Score mass{"mass", 0.03}, coulomb{"Coulomb", 0.05}, gain{"gain", 0.02}, delay{"delay", 1e-4};
  Score viscous{"viscous", 0.1}, weight{"weight", 0.1};
  int viscous_right = 0;
  for (int k = 0; k < arms; ++k) {
    // The method was made with arms 1000 to 1019 in view; these are others.
    const auto seed = static_cast<std::uint64_t>(5000 + k);
    const HiddenArm arm = hidden_arm(seed);
    const auto found = identified(arm, {.seconds = 30, .known_mass = kKnownMass, .seed = seed});
    if (!found) {
      ADD_FAILURE() << "arm " << k << ": " << found.error().message;
      continue;
    }
    EXPECT_TRUE(found->against.empty()) << "arm " << k << ": " << found->against.front();
    EXPECT_FALSE(found->constants.cables) << "arm " << k << " has none that stretches";
    const auto& plant = arm.file.simulated.plant;
    const ArmConstants& constants = found->constants;
    EXPECT_TRUE(constants.absolute);
    EXPECT_FALSE(found->friction.axes_differ || found->friction.directions_differ) << "arm " << k;
    for (const Saturation& one : found->saturation) EXPECT_TRUE(one.searched && !one.seen);
    mass.add(constants.mass, plant.mass);
    coulomb.add(constants.coulomb, plant.coulomb);
    viscous.add(constants.viscous, plant.viscous);
    weight.add(constants.weight, arm.weight);
    delay.add(constants.delay, arm.delay, false);
    for (std::size_t i = 0; i < 3; ++i) {
      gain.add(constants.gain[i], arm.gain[i]);
      EXPECT_GT(constants.gain[i].value, 0) << "the sign of motor " << i + 1 << " of arm " << k;
    }
    // What is too weak to be seen must be said by its interval.
    viscous_right += std::abs(constants.viscous.value / plant.viscous - 1) < viscous.most ||
                             constants.viscous.holds(plant.viscous)
                         ? 1
                         : 0;
  }
  int held = 0, all = 0;
  for (const Score* score : {&mass, &coulomb, &gain, &delay, &viscous, &weight}) {
    std::printf("%-8s worst %.3g of %.3g, %d of %d intervals hold the truth\n", score->name,
                score->worst, score->most, score->held, score->all);
    held += score->held;
    all += score->all;
  }
  for (const Score* score : {&mass, &coulomb, &gain, &delay}) {
    EXPECT_LT(score->worst, score->most) << score->name;
  }
  EXPECT_GE(viscous_right, 0.95 * arms);
  // Of 24 intervals in the short form all may hold by chance.
  EXPECT_GT(held, 0.90 * all);
  if (arms == 200) {
    EXPECT_LE(held, 0.99 * all);
  }
}

TEST(Identify, SeesOnlyRatiosWithoutAKnownMass) {
  const HiddenArm arm = hidden_arm(7);
  const auto found = identified(arm, {.seconds = 30});
  ASSERT_TRUE(found.ok()) << found.error().message;
  const ArmConstants& constants = found->constants;
  EXPECT_FALSE(constants.absolute);
  double log_gain = 0;
  for (const Estimate& gain : constants.gain) log_gain += std::log(gain.value);
  EXPECT_NEAR(log_gain, 0, 1e-12);
  double log_truth = 0;
  for (const double gain : arm.gain) log_truth += std::log(gain) / 3;
  const double scale = std::exp(log_truth);
  EXPECT_NEAR(constants.mass.value * scale / arm.file.simulated.plant.mass, 1, 0.02);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(constants.gain[i].value * scale / arm.gain[i], 1, 0.01);
  }
  EXPECT_NE(constants_table(*found, arm.file).find("--known-mass"), std::string::npos);
}

/// What is said of an arm that is another than the model's: an error, or what speaks against the
/// fit; empty if nothing is.
std::string said_of(std::uint64_t seed, const std::function<void(scene::ArmFile&)>& change,
                    bool hold_it = false, bool cables = true) {
  HiddenArm arm = hidden_arm(seed);
  arm.file.simulated.hand = {};
  change(arm.file);
  const auto found = identified(
      arm, {.seconds = is_long() ? 20.0 : 12.0, .cables = cables, .seed = seed}, hold_it);
  if (!found) return found.error().message;
  return found->against.empty() ? "" : found->against.front();
}

TEST(Identify, TellsAWrongModelApart) {
  const auto cable = [](scene::ArmFile& file) {
    auto& train = file.simulated.drive_train;
    train.stiffness.setConstant(20);
    train.inertia.setConstant(5e-4);
    train.damping.setConstant(0.01);
  };
  for (std::uint64_t seed = 1; seed <= (is_long() ? 10 : 1); ++seed) {
    EXPECT_EQ(said_of(seed, [](auto&) {}), "");
    EXPECT_EQ(said_of(seed, cable), "");
    EXPECT_NE(said_of(seed, cable, false, false).find("not that of a rigid arm"),
              std::string::npos);
    EXPECT_NE(said_of(seed,
                      [](scene::ArmFile& file) {
                        file.simulated.drive_train.cogging.setConstant(0.0005);
                        file.simulated.drive_train.periods_per_turn = 7;
                      })
                  .find("not that of a rigid arm"),
              std::string::npos);
    EXPECT_NE(said_of(seed,
                      [&](scene::ArmFile& file) {
                        cable(file);
                        file.simulated.drive_train.stiffness.setConstant(2000);
                        file.simulated.drive_train.inertia.setConstant(1e-5);
                        file.simulated.drive_train.coulomb.y() = 0.02;
                      }),
              "")
        << "a joint that sticks";
    EXPECT_NE(said_of(
                  seed,
                  [](scene::ArmFile& file) {
                    file.simulated.hand = {.mass = 0, .stiffness = 30, .damping = 0.5};
                  },
                  true)
                  .find("Something holds the tip like a spring of"),
              std::string::npos);
    const std::string held = said_of(
        seed,
        [](scene::ArmFile& file) {
          file.simulated.hand = {.mass = 0.025, .stiffness = 300, .damping = 3};
        },
        true);
    EXPECT_NE(held, "") << "a hand that holds";
    EXPECT_EQ(held.find("pulls against its encoder"), std::string::npos) << "no sign is wrong";
    EXPECT_NE(said_of(seed, [](scene::ArmFile& file) { file.simulated.wire.jitter_ns = 500'000; })
                  .find("without a new report"),
              std::string::npos);
  }
}

TEST(Identify, NamesAMotorThatIsTurnedRoundOrDead) {
  for (std::uint64_t seed = 1; seed <= (is_long() ? 10 : 3); ++seed) {
    for (int motor = 0; motor < 3; ++motor) {
      const std::string name = "Motor " + std::to_string(motor + 1);
      const auto gained = [motor](double by) {
        return [motor, by](scene::ArmFile& file) {
          file.simulated.firmware.wiring.motor_gain[motor] *= by;
        };
      };
      EXPECT_EQ(said_of(seed, gained(-1)).find(name + " pulls against its encoder"), 0U);
      EXPECT_EQ(said_of(seed, gained(0)).find(name + " moved its joint by"), 0U);
    }
  }
}

TEST(Identify, NeverAsksForMoreThanItSaysNorGoesFar) {
  for (std::uint64_t seed = 1; seed <= (is_long() ? 200 : 2); ++seed) {
    HiddenArm arm = hidden_arm(seed);
    for (const double pull : {0.0, arm.file.simulated.plant.coulomb + 0.03, 5.0}) {
      // Something pulls the tip away, as hard as it may.
      scene::ArmFile file = arm.file;
      file.simulated.firmware.wiring.motor_gain.setOnes();
      file.simulated.weight_B = {pull, 0, 0};
      auto bench = simulated_bench(file, 0);
      ASSERT_TRUE(bench.ok());
      const std::atomic<bool> never{false};
      Eigen::Vector3d begin(0, 0, 0);
      int pushed = 0;
      // Every command, asked for and sent, from the first push of a motor on.
      (*bench)->watch([&](const driver::TickRecord& tick) {
        const Eigen::Vector3d wanted(tick.f_wanted_W.data()), sent(tick.f_sent_W.data());
        const Eigen::Vector3d p_WT(tick.p_WT.data());
        ASSERT_LE(wanted.norm(), kIdentifyForceMax);
        ASSERT_LE(sent.norm(), kIdentifyForceMax);
        if (pushed == 0) begin = p_WT;
        pushed += wanted.isZero(0) ? 0 : 1;
        const bool far = (p_WT - begin).norm() >= Excitation::kFar;
        ASSERT_TRUE(!far || wanted.isZero(0)) << "asked to move on beyond its space";
      });
      const auto motion = record_motion(**bench, file, {.seconds = 10, .seed = seed}, never);
      EXPECT_EQ(motion.ok(), pull == 0) << pull;
      EXPECT_EQ(pushed > 9000, pull == 0) << pushed;
      // Rounded currents may make a force some mN longer.
      EXPECT_LT((*bench)->true_force_max(), kIdentifyForceMax + 0.01);
      EXPECT_TRUE((*bench)->device().zero_assured());
      if (!motion) continue;
      for (const MotionSample& sample : motion->samples) {
        ASSERT_LT((sample.p_BT - (file.R_WB.transpose() * (begin - file.p_WB))).norm(), 0.042);
      }
    }
  }
}

TEST(Identify, EndsWithZeroForceWhenItIsStopped) {
  const HiddenArm arm = hidden_arm(3);
  auto bench = simulated_bench(arm.file, 0);
  ASSERT_TRUE(bench.ok());
  const std::atomic<bool> stopped{true};
  EXPECT_TRUE(support::refuses(record_motion(**bench, arm.file, {}, stopped), "stopped"));
  EXPECT_TRUE((*bench)->device().zero_assured());
  EXPECT_EQ((*bench)->true_force_max(), 0);
}

}  // namespace
}  // namespace thimble::app
