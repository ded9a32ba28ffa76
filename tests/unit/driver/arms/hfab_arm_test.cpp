#include "arms/hfab/hfab_wire.h"

#include <gtest/gtest.h>

#include <cmath>
#include <type_traits>

#include "arms/hfab/hfab_report.h"
#include "support/random.h"
#include "support/vintage_arm.h"

namespace thimble::driver::hfab {
namespace {

TEST(HfabArm, ZeroCountsAreTheHomePose) {
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
  for (const int times : {1, 65536}) {
    const auto model = with_fine_counts(support::vintage_model(), times);
    for (int i = 0; i < 1000; ++i) {
      const Eigen::Vector3d q = support::vintage_home() + random.in_box(0.7);
      const Eigen::Vector3d exact = model.exact_counts(q);
      ArmReading reading;
      for (std::size_t j = 0; j < 3; ++j) {
        reading.counts[j] =
            static_cast<std::int32_t>(std::floor(exact[static_cast<Eigen::Index>(j)]));
      }
      for (std::size_t j = 0; j < 3; ++j) {
        const auto k = static_cast<Eigen::Index>(j);
        EXPECT_LE(std::abs(model.joint_angles(reading)[k] - q[k]), model.step(j) * (1 + 1e-6));
      }
    }
  }
}

TEST(HfabArm, WholeAndFineCountsGiveTheSameAngles) {
  const auto whole = support::vintage_model();
  const auto fine = with_fine_counts(whole);
  support::Random random(22);
  for (int i = 0; i < 1000; ++i) {
    ArmReading a, b;
    for (std::size_t j = 0; j < 3; ++j) {
      a.counts[j] = static_cast<std::int16_t>(random.bits());
      b.counts[j] = a.counts[j] * 65536;
    }
    ASSERT_EQ(whole.joint_angles(a), fine.joint_angles(b));
  }
}

TEST(HfabArm, ReadsFractionsOfCountsWithoutASign) {
  InputReport report;
  report.counts = {-1, 2, 0, static_cast<std::int16_t>(static_cast<std::uint16_t>(65535)), 7, 0};
  ArmReading reading;
  ASSERT_TRUE(FineReportWire::decode(encode_input(report), reading));
  EXPECT_EQ(reading.counts, (std::array<std::int32_t, 3>{-1, 2 * 65536 + 7, 0}));
}

TEST(HfabArm, RoundsCurrentsAsTheLibraryDoes) {
  // whole_mA rounds halves away from zero; values just below a half are rounded down.
  EXPECT_EQ(whole_mA(MotorCurrents())[0], 0);
  support::Random random(23);
  for (int i = 0; i < 100'000; ++i) {
    const double half = std::floor(random.uniform(-40'000, 40'000)) + 0.5;
    for (const double exact :
         {half, std::nextafter(half, 0.0), std::nextafter(half, 2 * half), 0.49999999999999994,
          -0.49999999999999994, random.uniform(-40'000, 40'000)}) {
      const double kept = std::clamp(exact, -32767.0, 32767.0);
      ASSERT_EQ(round_half_away(kept), std::lround(kept)) << exact;
    }
  }
}

TEST(HfabArm, RejectedReportLeavesTheReadingUnchanged) {
  const HfabArm arm(support::vintage_model());
  ArmReading reading{.counts = {1, 2, 3}, .auxiliary = {}, .buttons = 1};
  const std::array<std::byte, 13> torn{};
  EXPECT_FALSE(arm.decode(torn, reading));
  EXPECT_EQ(reading.counts[2], 3);
  EXPECT_EQ(reading.buttons, 1);
}

TEST(HfabArm, SendsOnlyForcesFromTheGate) {
  // The only path to the motors: neither a plain force nor plain currents can be encoded, and only
  // SafetyGate can create a gated force that is not zero.
  static_assert(!std::is_convertible_v<Eigen::Vector3d, MotorCurrents>);
  static_assert(!std::is_constructible_v<MotorCurrents, Eigen::Vector3d>);
  static_assert(!std::is_constructible_v<GatedForce, Eigen::Vector3d>);
  EXPECT_EQ(GatedForce().f_T_W().norm(), 0);
  EXPECT_EQ(MotorCurrents().amperes().norm(), 0);
}

}  // namespace
}  // namespace thimble::driver::hfab
