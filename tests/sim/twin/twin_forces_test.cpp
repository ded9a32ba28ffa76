#include "twin/twin_forces.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <sstream>

#include "bringup/identify/record_motion.h"
#include "bringup/identify/simulated_bench.h"
#include "support/identify/hidden_arm.h"
#include "support/identify/rigid_rubbing_arm.h"

namespace thimble::twin {
namespace {

using support::hidden_arm;
using support::HiddenArm;

/// Returns the recorded motion of a hidden arm, interpreted with `file`; a hand holds the arm if
/// `hold_it`.
TwinMotion motion_of(const HiddenArm& arm, bool hold_it) {
  session::Recording recording;
  std::ostringstream text;
  text << std::ifstream(std::string(THIMBLE_SOURCE_DIR) + "/app/arms/vintage_phantom.yaml").rdbuf();
  recording.info.arm = "vintage_phantom";
  recording.info.arm_text = text.str();
  recording.info.device = "sim";
  recording.info.rate = 1000;
  recording.complete = true;
  auto bench = bringup::simulated_bench(arm.file, 0, hold_it);
  EXPECT_TRUE(bench.ok());
  (*bench)->watch([&](const driver::TickRecord& tick) { recording.ticks.push_back(tick); });
  const std::atomic<bool> never{false};
  const auto ran = bringup::record_motion(**bench, arm.file, {.seconds = 5, .seed = 1}, never);
  EXPECT_TRUE(ran.ok()) << ran.error().message;
  return twin_motion(recording, arm.file).value();
}

TEST(TwinForces, EqualMotorForcesOnAFreeTip) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const HiddenArm arm = hidden_arm(seed);
    const TwinForces found = twin_forces(motion_of(arm, false), arm.file);
    EXPECT_FALSE(found.other_acted()) << seed << "\n" << force_table(found);
    for (const TwinForceAxis& axis : found.axes) {
      EXPECT_GT(axis.counted, 50U);
      EXPECT_NEAR(axis.needed_rms / axis.motors_rms, 1, 0.03) << axis.name;
    }
  }
}

TEST(TwinForces, DetectAHandOnTheTip) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    HiddenArm arm = hidden_arm(seed);
    arm.file.simulated.hand = {.mass = 0.02, .stiffness = 60, .damping = 1};
    const TwinForces found = twin_forces(motion_of(arm, true), arm.file);
    ASSERT_TRUE(found.hand_held()) << seed << "\n" << force_table(found);
    EXPECT_NEAR(found.hand.stiffness, 60, 3) << seed;
    EXPECT_NEAR(found.hand.damping, 1, 0.1) << seed;
    EXPECT_NEAR(found.hand.mass, 0.02, 0.003) << seed;
    EXPECT_NE(force_table(found).find("held the tip like a hand"), std::string::npos);
  }
}

TEST(TwinForces, IncludeTheFrictionOfJoints) {
  for (std::uint64_t seed = 8000; seed <= 8001; ++seed) {
    const HiddenArm arm = support::rigid_rubbing_arm(seed);
    const TwinMotion motion = motion_of(arm, false);
    const TwinForces found = twin_forces(motion, arm.file);
    EXPECT_FALSE(found.other_acted()) << seed << "\n" << force_table(found);
    for (const TwinForceAxis& axis : found.axes) EXPECT_GT(axis.counted, 50U);
    scene::ArmFile wrong = arm.file;
    wrong.simulated.drive_train.coulomb.setZero();
    wrong.simulated.drive_train.viscous.setZero();
    EXPECT_TRUE(twin_forces(motion, wrong).other_acted()) << seed;
  }
}

TEST(TwinForces, ReportAWrongConstantInsteadOfAHand) {
  const HiddenArm arm = hidden_arm(2);
  const TwinMotion motion = motion_of(arm, false);
  scene::ArmFile wrong = arm.file;
  for (auto& drive : wrong.model.drives) drive.torque_constant *= 1.3;
  const TwinForces found = twin_forces(motion, wrong);
  EXPECT_TRUE(found.other_acted());
  EXPECT_FALSE(found.hand_held()) << force_table(found);
  EXPECT_GT(found.axes[0].other_rms, 0.15 * found.axes[0].motors_rms);
}

}  // namespace
}  // namespace thimble::twin
