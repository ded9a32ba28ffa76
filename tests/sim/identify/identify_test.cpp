#include "bringup/identify/identify.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "bringup/identify/arm_constants.h"
#include "bringup/identify/constants_table.h"
#include "bringup/identify/excitation.h"
#include "bringup/identify/record_motion.h"
#include "bringup/identify/simulated_bench.h"
#include "gravity_terms.h"
#include "support/identify/identified_arm.h"
#include "support/long_form.h"
#include "support/refuses.h"

namespace thimble::bringup {
namespace {

using support::hidden_arm;
using support::HiddenArm;
using support::identified;
using support::kKnownMass;
using support::long_form;
using support::random_hand;
using support::Score;
using support::wide_hidden_arm;

/// Returns the share of the requested torque that the weakest motor of an arm gives.
double weakest(const HiddenArm& arm) {
  return *std::min_element(arm.gain.begin(), arm.gain.end());
}

/// Returns whether an arm's friction is too high for its motors to be identified with 0.95 N along
/// all axes.
bool is_too_stiff(const HiddenArm& arm) {
  return 6 * arm.file.simulated.plant.coulomb > weakest(arm);
}

/// Returns whether 0.95 N from an arm's weakest motor carries less than one and a half times the
/// known mass.
bool is_too_weak(const HiddenArm& arm) {
  return 0.95 * weakest(arm) < 1.5 * kKnownMass * scene::kGravity;
}

/// Returns whether an arm's strongest motor is six times as strong as its weakest.
bool is_uneven(const HiddenArm& arm) {
  return *std::max_element(arm.gain.begin(), arm.gain.end()) > 6 * weakest(arm);
}

TEST(Identify, FindsConstantsOrReportsTooMuchFriction) {
  // The method was developed with arms 1000 to 1019; these are different. 5012 is a Polhem, whose
  // strong motors have little friction compared with its weight.
  std::vector<std::uint64_t> seeds = {5001, 5002, 5005, 5012};
  for (std::uint64_t k = 0; long_form() && k < 200; ++k) {
    if (k == 0) seeds.clear();
    seeds.push_back(5000 + k);
  }
  Score mass{"mass", 0.03}, coulomb{"Coulomb", 0.05}, gain{"gain", 0.02}, delay{"delay", 1e-4};
  Score viscous{"viscous", 0.1}, weight{"weight", 0.1};
  int viscous_right = 0, refused = 0;
  for (const std::uint64_t seed : seeds) {
    SCOPED_TRACE(seed);
    const HiddenArm arm = wide_hidden_arm(seed);
    const auto found = identified(
        arm, {.seconds = long_form() ? 30.0 : 12.0, .known_mass = kKnownMass, .seed = seed});
    if (!found || !found->against.empty()) {
      const std::string said = found ? found->against.front() : found.error().message;
      const bool away = said.find("left its allowed space") != std::string::npos;
      EXPECT_TRUE(away ? is_too_weak(arm) || is_uneven(arm) : is_too_stiff(arm)) << said;
      EXPECT_TRUE(away || said.find("The tip was at rest") != std::string::npos ||
                  said.find("moved its joint by") != std::string::npos ||
                  said.find("its friction is too high for the allowed 1 N") != std::string::npos ||
                  said.find("compared with its dry friction") != std::string::npos)
          << said;
      ++refused;
      continue;
    }
    EXPECT_FALSE(found->constants.cables) << "it has no cable that stretches";
    EXPECT_FALSE(found->waves.seen()) << "its motors have no cogging";
    const auto& plant = arm.file.simulated.plant;
    const ArmConstants& constants = found->constants;
    EXPECT_TRUE(constants.absolute);
    mass.add(constants.mass, plant.mass);
    coulomb.add(constants.coulomb, plant.coulomb);
    viscous.add(constants.viscous, plant.viscous);
    weight.add(constants.weight, arm.weight);
    delay.add(constants.delay, arm.delay, false);
    for (std::size_t i = 0; i < 3; ++i) {
      gain.add(constants.gain[i], arm.gain[i]);
      EXPECT_GT(constants.gain[i].value, 0) << "the sign of motor " << i + 1;
    }
    // The interval of an effect too weak to be measured must contain it.
    viscous_right += std::abs(constants.viscous.value / plant.viscous - 1) < viscous.max ||
                             constants.viscous.holds(plant.viscous)
                         ? 1
                         : 0;
  }
  const int arms = static_cast<int>(seeds.size());
  int held = 0, all = 0;
  std::printf("%d of %d arms refused\n", refused, arms);
  for (const Score* score : {&mass, &coulomb, &gain, &delay, &viscous, &weight}) {
    score->print();
    if (long_form()) {
      EXPECT_GE(score->held, 0.9 * score->all) << score->name;
    }
    held += score->held;
    all += score->all;
  }
  for (const Score* score : {&mass, &coulomb, &gain, &delay}) {
    EXPECT_LT(score->worst, score->max) << score->name;
  }
  EXPECT_LT(refused, 0.5 * arms);
  EXPECT_GE(viscous_right, 0.95 * (arms - refused));
  // In the short form there are few intervals, of which one may miss by chance.
  EXPECT_GT(held, (long_form() ? 0.90 : 0.80) * all);
}

TEST(Identify, ReportsAHandOnTheTip) {
  // From two fingers that barely touch it to a firm grip.
  for (std::uint64_t seed = 1; seed <= (long_form() ? 60 : 2); ++seed) {
    SCOPED_TRACE(seed);
    HiddenArm arm = long_form() && seed % 3 != 2 ? wide_hidden_arm(seed) : hidden_arm(seed);
    arm.file.simulated.hand = random_hand(seed);
    const auto found = identified(arm, {.seconds = 12, .seed = seed}, true);
    ASSERT_FALSE(found.ok() && found->against.empty()) << "a hand was mistaken for the arm";
    const std::string said = found ? found->against.front() : found.error().message;
    EXPECT_EQ(said.find("pulls against its encoder"), std::string::npos) << "no sign is wrong";
    EXPECT_TRUE(said.find("grip") != std::string::npos ||
                said.find("The tip was at rest") != std::string::npos)
        << said;
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

/// Returns the error of a fit or the first reason to distrust it; empty if there is neither.
std::string said_of(const driver::Result<Identified>& found) {
  if (!found) return found.error().message;
  return found->against.empty() ? "" : found->against.front();
}

/// Returns the same for an arm that differs from the model.
std::string said_of(std::uint64_t seed, const std::function<void(scene::ArmFile&)>& change,
                    bool hold_it = false, bool cables = true, bool play = long_form()) {
  HiddenArm arm = hidden_arm(seed);
  arm.file.simulated.hand = {};
  change(arm.file);
  return said_of(identified(
      arm, {.seconds = long_form() ? 20.0 : 12.0, .cables = cables, .play = play, .seed = seed},
      hold_it));
}

void soften_cables(scene::ArmFile& file) {
  auto& train = file.simulated.drive_train;
  train.stiffness.setConstant(20);
  train.inertia.setConstant(5e-4);
  train.damping.setConstant(0.01);
}

/// Returns whether the arm is so heavy that its links oscillate below 15 Hz on cables of 20 N
/// m/rad.
bool oscillates_below_lines(std::uint64_t seed) {
  return hidden_arm(seed).file.simulated.plant.mass > 0.12;
}

TEST(Identify, DetectsAWrongModel) {
  for (std::uint64_t seed = 1; seed <= (long_form() ? 10 : 1); ++seed) {
    SCOPED_TRACE(seed);
    EXPECT_EQ(said_of(seed, [](auto&) {}), "");
    if (!oscillates_below_lines(seed)) {
      EXPECT_EQ(said_of(seed, soften_cables), "");
      EXPECT_NE(said_of(seed, soften_cables, false, false).find("does not fit a rigid arm"),
                std::string::npos);
    }
    EXPECT_EQ(said_of(seed,
                      [](scene::ArmFile& file) {
                        file.simulated.drive_train.cogging.setConstant(0.0005);
                        file.simulated.drive_train.periods_per_turn = 7;
                      }),
              "");
    // Friction of a joint is measured like backlash if its cable stretches.
    const auto rub = [&](scene::ArmFile& file) {
      soften_cables(file);
      file.simulated.drive_train.stiffness.setConstant(2000);
      file.simulated.drive_train.inertia.setConstant(1e-5);
      file.simulated.drive_train.coulomb.y() = 0.02;
    };
    const std::string stuck = said_of(seed, rub, false, true, false);
    EXPECT_EQ(stuck.find("Joint 2 sticks"), 0U) << stuck;
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
    // A little jitter does not make the model wrong: ticks follow the latest reports.
    EXPECT_EQ(said_of(seed, [](scene::ArmFile& file) { file.simulated.wire.jitter_ns = 200'000; }),
              "");
  }
}

TEST(Identify, ReportsCablesSofterThanTheSearchRange) {
  for (const std::uint64_t seed : {2, 7, 22}) {
    SCOPED_TRACE(seed);
    ASSERT_TRUE(oscillates_below_lines(seed));
    const std::string said = said_of(seed, soften_cables, false, true, false);
    EXPECT_NE(said.find("oscillates on its cable at "), std::string::npos) << said;
    EXPECT_NE(said.find("cables are identified from 15 Hz on"), std::string::npos) << said;
  }
}

TEST(Identify, NamesCablesThatWereNotSearchedFor) {
  for (std::uint64_t seed = 1; seed <= (long_form() ? 10 : 1); ++seed) {
    for (const double stiffness : {200.0, 2000.0}) {
      HiddenArm arm = hidden_arm(seed);
      auto& train = arm.file.simulated.drive_train;
      train.stiffness.setConstant(stiffness);
      train.inertia.setConstant(1e-4);
      train.damping.setConstant(0.01);
      const auto found = identified(arm, {.seconds = 12, .cables = false, .seed = seed});
      ASSERT_TRUE(found.ok()) << found.error().message;
      EXPECT_TRUE(std::any_of(
          found->against.begin(), found->against.end(),
          [](const auto& one) { return one.find("cables stretch") != std::string::npos; }))
          << stiffness << ": " << said_of(found);
    }
  }
}

TEST(Identify, ReportsAHandThatMovesTheTip) {
  for (std::uint64_t seed = 1; seed <= (long_form() ? 10 : 1); ++seed) {
    HiddenArm arm = hidden_arm(seed);
    arm.file.simulated.hand = {.mass = 0.02, .stiffness = 60, .damping = 1};
    const Eigen::Vector3d middle = arm.file.workspace.middle();
    std::vector<std::pair<double, Eigen::Vector3d>> path = {{0, middle}};
    for (int k = 1; k < 30; ++k) {
      path.emplace_back(k, middle + Eigen::Vector3d(k % 2 == 0 ? 0.008 : -0.008, 0, 0));
    }
    const OpenBench open = [&](bool) {
      return BenchArm::open(arm.file, {}, {}, path, kIdentifyForceMax);
    };
    const std::atomic<bool> never{false};
    const std::string said =
        said_of(identify(open, arm.file, {.seconds = 12, .seed = seed}, never));
    EXPECT_NE(said.find("the grip"), std::string::npos) << said;
  }
}

TEST(Identify, NamesAReversedOrDeadMotor) {
  for (std::uint64_t seed = 1; seed <= (long_form() ? 10 : 3); ++seed) {
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

TEST(Identify, StaysWithinForceAndDistanceLimits) {
  for (std::uint64_t seed = 1; seed <= (long_form() ? 200 : 2); ++seed) {
    HiddenArm arm = hidden_arm(seed);
    for (const double pull : {0.0, arm.file.simulated.plant.coulomb + 0.03, 5.0}) {
      // Something pulls the tip away with the maximum force.
      scene::ArmFile file = arm.file;
      file.simulated.firmware.wiring.motor_gain.setOnes();
      file.simulated.weight_B = {pull, 0, 0};
      auto bench = simulated_bench(file, 0);
      ASSERT_TRUE(bench.ok());
      const std::atomic<bool> never{false};
      Eigen::Vector3d begin(0, 0, 0);
      int pushed = 0;
      // Every force, requested and sent, from the first push of a motor on.
      (*bench)->watch([&](const driver::TickRecord& tick) {
        const Eigen::Vector3d wanted(tick.f_wanted_W.data()), sent(tick.f_sent_W.data());
        const Eigen::Vector3d p_WT(tick.p_WT.data());
        ASSERT_LE(wanted.norm(), kIdentifyForceMax);
        ASSERT_LE(sent.norm(), kIdentifyForceMax);
        if (pushed == 0) begin = p_WT;
        pushed += wanted.isZero(0) ? 0 : 1;
        const bool far = (p_WT - begin).norm() >= Excitation::kFar;
        ASSERT_TRUE(!far || wanted.isZero(0)) << "force requested outside of its space";
      });
      const auto motion = record_motion(**bench, file, {.seconds = 10, .seed = seed}, never);
      EXPECT_EQ(motion.ok(), pull == 0) << pull;
      EXPECT_EQ(pushed > 9000, pull == 0) << pushed;
      // Rounded currents may increase a force by a few mN.
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
  EXPECT_TRUE(support::refuses(record_motion(**bench, arm.file, {}, stopped), "Stopped"));
  EXPECT_TRUE((*bench)->device().zero_assured());
  EXPECT_EQ((*bench)->true_force_max(), 0);
}

}  // namespace
}  // namespace thimble::bringup
