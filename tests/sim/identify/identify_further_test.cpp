// Properties beyond the constants of the arm file: friction by axis and direction, and amplifiers
// that saturate.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <string>

#include "bringup/identify/unidentified_parameters.h"
#include "support/identify/identified_arm.h"
#include "support/long_form.h"
#include "support/random.h"

namespace thimble::bringup {
namespace {

using support::hidden_arm;
using support::HiddenArm;
using support::identified;
using support::kKnownMass;
using support::long_form;
using support::Random;

TEST(IdentifyFriction, IsReportedForDirectionsThatDiffer) {
  // Friction c+ in one direction and c- in the other equals exactly their mean plus a constant
  // force of half their difference. The arm is simulated in that form.
  const int arms = long_form() ? 60 : 1;
  int reported = 0, held = 0, all = 0;
  double worst = 0;
  for (int k = 0; k < arms; ++k) {
    const auto seed = static_cast<std::uint64_t>(11'000 + k);
    HiddenArm arm = hidden_arm(seed);
    Random random(seed);
    const double coulomb = arm.file.simulated.plant.coulomb;
    Eigen::Vector3d uneven_W(0, 0, 0);
    for (int axis = 0; axis < 2; ++axis) {
      const double share = random.uniform(0.1, 0.4);
      uneven_W[axis] = (random.bits() % 2 == 0 ? 1 : -1) * share * coulomb;
    }
    // Nothing else pulls, so the tip stays in place.
    arm.file.simulated.weight_B = arm.file.R_WB.transpose() * uneven_W;
    const auto found = identified(
        arm, {.seconds = long_form() ? 30.0 : 15.0, .known_mass = kKnownMass, .seed = seed});
    ASSERT_TRUE(found.ok()) << found.error().message;
    const FrictionDirections& friction = found->friction;
    reported += friction.directions_differ ? 1 : 0;
    const Eigen::Vector3d uneven_B = arm.file.R_WB.transpose() * uneven_W;
    for (int axis = 0; axis < 3; ++axis) {
      if (!friction.is_observable(axis)) continue;
      const Estimate& one = friction.uneven[static_cast<std::size_t>(axis)];
      worst = std::max(worst, std::abs(one.value - uneven_B[axis]) / coulomb);
      held += one.holds(uneven_B[axis]) ? 1 : 0;
      ++all;
    }
  }
  std::printf("%d of %d arms reported; worst %.3g of the friction; %d of %d intervals hold\n",
              reported, arms, worst, held, all);
  EXPECT_EQ(reported, arms);
  EXPECT_LT(worst, 0.05);
  EXPECT_GT(held, 0.85 * all);
}

TEST(IdentifySaturation, NamesTheSaturatedMotor) {
  const int arms = long_form() ? 30 : 1;
  int held = 0, all = 0;
  double worst = 0;
  for (int k = 0; k < arms; ++k) {
    const auto seed = static_cast<std::uint64_t>(13'000 + k);
    HiddenArm arm = hidden_arm(seed);
    // Half of the largest torque requested from the first motor.
    const auto& first = arm.file.model.drives[0];
    arm.file.simulated.motors.current_max = 0.07 / std::abs(first.ratio * first.torque_constant);
    const auto found = identified(arm, {.seconds = 12, .seed = seed});
    ASSERT_TRUE(found.ok()) << found.error().message;
    int seen = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const Saturation& one = found->saturation[i];
      if (!one.seen) continue;
      ++seen;
      const auto& drive = arm.file.model.drives[i];
      const double truth = arm.file.simulated.motors.current_max / arm.gain[i] *
                           std::abs(drive.ratio * drive.torque_constant);
      std::printf("motor %zu: %.4g +- %.2g N m, true %.4g\n", i + 1, one.max_torque.value,
                  one.max_torque.plus_minus, truth);
      worst = std::max(worst, std::abs(one.max_torque.value / truth - 1));
      held += one.max_torque.holds(truth) ? 1 : 0;
      ++all;
    }
    EXPECT_GE(seen, 1);
    ASSERT_FALSE(found->against.empty());
    EXPECT_NE(found->against.front().find("gives at most"), std::string::npos);
  }
  std::printf("worst %.3g, %d of %d intervals hold\n", worst, held, all);
  EXPECT_LT(worst, 0.12);
  // One of three intervals may miss by chance.
  EXPECT_GE(held, std::min(0.85 * all, all - 1.0));
}

}  // namespace
}  // namespace thimble::bringup
