#include "thimble/driver/arms/hfab/hfab_arm.h"

#include <gtest/gtest.h>

#include <cmath>
#include <type_traits>

#include "arms/hfab/hfab_report.h"
#include "support/random.h"
#include "support/vintage_arm.h"

namespace thimble::driver::hfab {
namespace {

TEST(HfabArm, StandsAtHomeWhenItsCountersAreZero) {
  const HfabArm arm(support::vintage_model());
  const ArmPose pose = arm.pose({});
  EXPECT_LT((pose.q - support::vintage_home()).norm(), 1e-15);
  EXPECT_LT((pose.p_BT - Eigen::Vector3d(0.138, 0, -0.112)).norm(), 1e-15);
}

TEST(HfabArm, HasTheTipResolutionOfItsGeometry) {
  // DEVICES.md section 2, vintage PHANTOM refit: 0.024, 0.028, 0.023 mm per count.
  const HfabArm arm(support::vintage_model());
  const double expected_mm[] = {0.024, 0.028, 0.023};
  const Eigen::Vector3d home = arm.pose({}).p_BT;
  for (std::size_t joint = 0; joint < 3; ++joint) {
    ArmReading one_count;
    one_count.counts[joint] = 1;
    EXPECT_NEAR((arm.pose(one_count).p_BT - home).norm() * 1e3, expected_mm[joint], 0.0005);
  }
}

TEST(HfabArm, TurnsJointAnglesIntoCountsAndBack) {
  support::Random random(21);
  for (const bool fractional : {false, true}) {
    HfabModel model = support::vintage_model();
    model.fractional_counts = fractional;
    for (int i = 0; i < 1000; ++i) {
      const Eigen::Vector3d q = support::vintage_home() + random.in_box(0.7);
      const Eigen::Vector3d exact = model.exact_counts(q);
      ArmReading reading;
      for (std::size_t j = 0; j < 3; ++j) {
        const double whole = std::floor(exact[static_cast<int>(j)]);
        reading.counts[j] = static_cast<std::int32_t>(whole);
        reading.auxiliary[j] =
            static_cast<std::int32_t>((exact[static_cast<int>(j)] - whole) * 65536);
      }
      for (int j = 0; j < 3; ++j) {
        const double step = model.step(j) / (fractional ? 65536 : 1);
        EXPECT_LE(std::abs(model.joint_angles(reading)[j] - q[j]), step * (1 + 1e-6));
      }
    }
  }
}

TEST(HfabArm, ReadsFractionsOfCountsWithoutASign) {
  HfabModel model = support::vintage_model();
  model.fractional_counts = true;
  const HfabArm arm(model);
  InputReport report;
  report.counts[3] = static_cast<std::int16_t>(static_cast<std::uint16_t>(65535));
  ArmReading reading;
  ASSERT_TRUE(arm.decode(encode_input(report), reading));
  EXPECT_EQ(reading.auxiliary[0], 65535);
}

TEST(HfabArm, LeavesTheReadingAloneWhenItRejectsAReport) {
  const HfabArm arm(support::vintage_model());
  ArmReading reading{.counts = {1, 2, 3}, .auxiliary = {}, .buttons = 1};
  const std::array<std::byte, 13> torn{};
  EXPECT_FALSE(arm.decode(torn, reading));
  EXPECT_EQ(reading.counts[2], 3);
  EXPECT_EQ(reading.buttons, 1);
}

TEST(HfabArm, SendsNothingThatDidNotPassTheGate) {
  // The one exit to the motors: neither a plain force nor plain currents can be encoded, and only
  // SafetyGate can make a gated force that is not zero.
  static_assert(!std::is_convertible_v<Eigen::Vector3d, MotorCurrents>);
  static_assert(!std::is_constructible_v<MotorCurrents, Eigen::Vector3d>);
  static_assert(!std::is_constructible_v<GatedForce, Eigen::Vector3d>);
  EXPECT_EQ(GatedForce().f_T_W().norm(), 0);
  EXPECT_EQ(MotorCurrents().amperes().norm(), 0);
}

}  // namespace
}  // namespace thimble::driver::hfab
