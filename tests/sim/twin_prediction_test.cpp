#include "twin/twin_prediction.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <string>
#include <vector>

#include "bringup/identify/identify.h"
#include "bringup/identify/record_motion.h"
#include "bringup/identify/simulated_bench.h"
#include "stability/stability_laws.h"
#include "stability/wall_bench.h"
#include "support/hidden_arm.h"
#include "support/refuses.h"

namespace thimble::app {
namespace {

using support::hidden_arm;
using support::HiddenArm;

constexpr double kKnownMass = 0.025;  // kg

/// A hidden arm whose driver was given what identifying it found, and its twin: the simulated arm
/// that has these constants and nothing else.
struct HiddenAndTwin {
  scene::ArmFile arm, twin;
};

driver::Result<HiddenAndTwin> identified(const HiddenArm& hidden, std::uint64_t seed) {
  const OpenBench open = [&](bool loaded) {
    return simulated_bench(hidden.file, loaded ? kKnownMass : 0);
  };
  const std::atomic<bool> never{false};
  const auto found =
      identify(open, hidden.file, {.seconds = 15, .known_mass = kKnownMass, .seed = seed}, never);
  if (!found) return found.error();
  if (!found->against.empty()) return driver::Error{found->against.front()};
  const ArmConstants& constants = found->constants;
  HiddenAndTwin both{hidden.file, scene::load_arm("vintage_phantom").value()};
  auto& simulated = both.twin.simulated;
  simulated.plant = {.mass = constants.mass.value,
                     .viscous = std::max(0.0, constants.viscous.value),
                     .coulomb = constants.coulomb.value};
  simulated.weight_B = both.twin.R_WB.transpose() * Eigen::Vector3d(0, 0, -constants.weight.value);
  const auto delay_ns = static_cast<std::int64_t>(std::llround(1e9 * constants.delay.value));
  simulated.wire.delay_in_ns = std::min(simulated.wire.delay_in_ns, delay_ns);
  simulated.wire.delay_out_ns = delay_ns - simulated.wire.delay_in_ns;
  for (std::size_t i = 0; i < 3; ++i) {
    const double gain = constants.gain[i].value;
    both.twin.model.drives[i].torque_constant *= gain;
    both.arm.model.drives[i].torque_constant *= gain;
    both.arm.simulated.firmware.wiring.motor_gain[static_cast<Eigen::Index>(i)] /= gain;
  }
  return both;
}

/// Where a free tip was seen, tick by tick, under an excitation that it was not identified with.
std::vector<Eigen::Vector3d> free_motion(const scene::ArmFile& file, std::uint64_t seed) {
  std::vector<Eigen::Vector3d> p_WT;
  auto bench = simulated_bench(file, 0);
  if (!bench) {
    ADD_FAILURE() << bench.error().message;
    return p_WT;
  }
  (*bench)->watch([&](const driver::TickRecord& tick) {
    p_WT.emplace_back(tick.p_WT[0], tick.p_WT[1], tick.p_WT[2]);
  });
  const std::atomic<bool> never{false};
  const auto motion = record_motion(**bench, file, {.seconds = 10, .lead = 0, .seed = seed}, never);
  EXPECT_TRUE(motion.ok()) << motion.error().message;
  return p_WT;
}

/// How far two motions come apart, over the range of the first.
double apart(const std::vector<Eigen::Vector3d>& a, const std::vector<Eigen::Vector3d>& b) {
  if (a.empty() || a.size() != b.size()) return HUGE_VAL;
  Eigen::Vector3d least = a.front(), most = a.front();
  double farthest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    least = least.cwiseMin(a[i]);
    most = most.cwiseMax(a[i]);
    farthest = std::max(farthest, (a[i] - b[i]).norm());
  }
  return farthest / (most - least).maxCoeff();
}

/// The farthest that predictions were off, as shares.
struct Worst {
  double wall = 0, restitution = 0, flight = 0, motion = 0;
  int walls_far = 0;  // that were off by more than kWallMost
};

/// Of 20 walls one may be farther off: near its edge a stiff wall rests or does not by where
/// between two steps of the encoders each oscillation turns round, and an arm that differs by
/// nothing but where it was let go then carries another.
constexpr double kWallMost = 0.05;

void try_arm(const HiddenArm& hidden, std::uint64_t seed, Worst& worst) {
  const auto both = identified(hidden, seed);
  ASSERT_TRUE(both.ok()) << both.error().message;
  const auto true_of = twin_prediction(both->arm), told = twin_prediction(both->twin);
  ASSERT_TRUE(true_of.ok()) << true_of.error().message;
  ASSERT_TRUE(told.ok()) << told.error().message;
  const auto off = [](double value, double truth) { return std::abs(value / truth - 1); };
  const double wall = off(told->stiffest_wall, true_of->stiffest_wall);
  const double restitution = off(told->bounce.restitution, true_of->bounce.restitution);
  const double flight = off(told->bounce.flight, true_of->bounce.flight);
  const double motion = apart(free_motion(both->arm, ~seed), free_motion(both->twin, ~seed));
  EXPECT_LT(restitution, 0.05) << "arm " << seed;
  EXPECT_LT(flight, 0.05) << "arm " << seed;
  EXPECT_LT(motion, 0.02) << "arm " << seed;
  worst.walls_far += wall > kWallMost ? 1 : 0;
  worst.wall = std::max(worst.wall, wall);
  worst.restitution = std::max(worst.restitution, restitution);
  worst.flight = std::max(worst.flight, flight);
  worst.motion = std::max(worst.motion, motion);
}

void tell(const char* what, int arms, const Worst& worst) {
  std::printf(
      "%d %s: wall %.2f %% (%d by more than 5 %%), restitution %.2f %%, flight %.2f %%, motion "
      "%.2f %% "
      "off\n",
      arms, what, 100 * worst.wall, worst.walls_far, 100 * worst.restitution, 100 * worst.flight,
      100 * worst.motion);
  EXPECT_LE(20 * worst.walls_far, arms);
}

TEST(TwinPrediction, OfAnIdentifiedArmIsItsWallItsBounceAndItsFreeMotion) {
  const bool all = std::getenv("THIMBLE_LONG") != nullptr;
  // Amplifiers that lag are nothing that the twin knows of: it takes them for delay.
  for (const double lag : {0.0, 5e-4}) {
    const int arms = !all ? (lag > 0 ? 0 : 1) : (lag > 0 ? 20 : 60);
    Worst worst;
    for (int k = 0; k < arms; ++k) {
      const auto seed = static_cast<std::uint64_t>(7000 + k);
      HiddenArm hidden = hidden_arm(seed);
      hidden.file.simulated.drive_train.current_lag = lag;
      try_arm(hidden, seed, worst);
    }
    if (arms > 0) tell(lag > 0 ? "hidden arms that lag" : "hidden arms", arms, worst);
  }
}

TEST(TwinPrediction, OfAnArmThatCogsIsRefusedOrHoldsForWallAndBounce) {
  if (std::getenv("THIMBLE_LONG") == nullptr) GTEST_SKIP() << "12 arms: in the long form alone";
  constexpr int kArms = 12;
  int refused = 0;
  for (std::uint64_t seed = 1; seed <= kArms; ++seed) {
    HiddenArm hidden = hidden_arm(seed);
    hidden.file.simulated.drive_train.cogging.setConstant(2e-4);
    hidden.file.simulated.drive_train.periods_per_turn = 7;
    const auto both = identified(hidden, seed);
    if (!both) {
      EXPECT_NE(both.error().message.find("not that of a rigid arm"), std::string::npos);
      ++refused;
      continue;
    }
    const auto true_of = twin_prediction(both->arm), told = twin_prediction(both->twin);
    ASSERT_TRUE(true_of.ok() && told.ok());
    const double motion = apart(free_motion(both->arm, ~seed), free_motion(both->twin, ~seed));
    std::printf("arm %d: wall %.4g of %.4g, motion %.3f apart\n", static_cast<int>(seed),
                told->stiffest_wall, true_of->stiffest_wall, motion);
    EXPECT_NEAR(told->stiffest_wall / true_of->stiffest_wall, 1, 0.02);
    EXPECT_NEAR(told->bounce.restitution / true_of->bounce.restitution, 1, 0.02);
    EXPECT_NEAR(told->bounce.flight / true_of->bounce.flight, 1, 0.02);
    EXPECT_LT(motion, 0.12);
  }
  std::printf("%d of %d arms refused\n", refused, kArms);
  EXPECT_GE(refused, 9);
}

TEST(DropTrial, BouncesAsTheLawOfRestitutionSays) {
  scene::ArmFile arm = scene::load_arm("vintage_phantom").value();
  arm.simulated.plant.coulomb = 0;
  arm.simulated.weight_B.setZero();
  arm.simulated.firmware.ideal_encoders = true;
  arm.simulated.motors.current_max = 10;
  const auto& tip = arm.simulated.plant;
  const auto& wire = arm.simulated.wire;
  const double latency = 0.0005 + 1e-9 * static_cast<double>(wire.delay_in_ns + wire.delay_out_ns);
  for (const double stiffness : {100.0, 300.0, 1000.0}) {
    const DropTrial trial{.stiffness = stiffness, .falls = 40};
    const auto bounce = drop_on_wall(arm, trial);
    ASSERT_TRUE(bounce.ok()) << bounce.error().message;
    // What the late wall gives and friction takes is (K L - b) v^2 all along the contact. The pull
    // bends the oscillation's middle into the wall, so that it begins and ends before its sides by
    // an angle of tan = pull / (m w v).
    const double frequency = std::sqrt(stiffness / tip.mass);
    const double before = std::atan(trial.pull / (tip.mass * frequency * bounce->speed));
    const double of_v2 = (0.5 * std::numbers::pi + before + 0.5 * std::sin(2 * before)) /
                         (frequency * std::cos(before) * std::cos(before));
    const double law = std::exp((stiffness * latency - tip.viscous) / tip.mass * of_v2);
    // To the first order in K L^2 / m, which is 0.03 for the stiffest.
    EXPECT_NEAR(bounce->restitution / law, 1, 0.03) << stiffness;
    const double falls_back = 2 * bounce->restitution * bounce->speed * tip.mass / trial.pull;
    EXPECT_NEAR(bounce->flight / falls_back, 1, 0.02) << stiffness;
  }
}

TEST(DropTrial, SaysWhenNothingFallsOrBounces) {
  scene::ArmFile arm = scene::load_arm("vintage_phantom").value();
  DropTrial trial;
  trial.pull = 0.5 * arm.simulated.plant.coulomb;
  EXPECT_TRUE(support::refuses(drop_on_wall(arm, trial), "does not fall"));
  trial = {};
  trial.damping = 20;
  trial.stiffness = 100;
  EXPECT_TRUE(support::refuses(drop_on_wall(arm, trial), "does not leave the wall"));
  trial = {};
  trial.height = 0.5;
  EXPECT_TRUE(support::refuses(drop_on_wall(arm, trial), "out of the arm's reach"));
  EXPECT_TRUE(support::refuses(drop_on_wall(scene::load_arm("falcon").value(), {}), "board"));
}

}  // namespace
}  // namespace thimble::app
