#include "thimble/driver/serial_arm.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/random.h"

namespace thimble::driver {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kPoses = 10'000;

const SerialArm kArms[] = {
    {.height = 0, .length_b = 0.138, .length_c = 0.112},     // vintage PHANTOM
    {.height = 0.08, .length_b = 0.205, .length_c = 0.245},  // WoodenHaptics
    {.height = 0, .length_b = 0.1333, .length_c = 0.1333},   // Omni
};

/// Draws a pose on the working branch, in front of the yaw axis and away from both singularities.
Eigen::Vector3d any_pose(const SerialArm& arm, support::Random& random) {
  for (;;) {
    const double b = random.uniform(-0.5, kPi);
    const double sum = random.uniform(0.15, kPi - 0.15);
    const Eigen::Vector3d q{random.uniform(-kPi, kPi), b, sum - b};
    if (arm.length_b * std::sin(q[1]) + arm.length_c * std::sin(q[2]) > 0.02) return q;
  }
}

TEST(SerialArm, TipMatchesPublishedPoses) {
  const SerialArm& vintage = kArms[0];
  // Upper link level, lower link hanging: the home pose of the vintage PHANTOM.
  EXPECT_TRUE(vintage.forward({0, kPi / 2, 0}).isApprox(Eigen::Vector3d(0.138, 0, -0.112), 1e-15));
  // The same, a quarter turn to the user's right.
  EXPECT_TRUE(
      vintage.forward({kPi / 2, kPi / 2, 0}).isApprox(Eigen::Vector3d(0, 0.138, -0.112), 1e-15));
  // Upper link up, lower link level.
  EXPECT_TRUE(vintage.forward({0, 0, kPi / 2}).isApprox(Eigen::Vector3d(0.112, 0, 0.138), 1e-15));
}

TEST(SerialArm, FindsJointsThatBringTheTipBackWithin1e12) {
  support::Random random(11);
  for (const SerialArm& arm : kArms) {
    double worst_tip = 0;
    for (int i = 0; i < kPoses; ++i) {
      const Eigen::Vector3d q = any_pose(arm, random);
      const Eigen::Vector3d p_BT = arm.forward(q);
      const auto found = arm.inverse(p_BT);
      ASSERT_TRUE(found) << q.transpose();
      worst_tip = std::max(worst_tip, (arm.forward(*found) - p_BT).norm());
      EXPECT_LT((*found - q).norm(), 1e-12) << q.transpose();
    }
    EXPECT_LT(worst_tip, 1e-12);
  }
}

TEST(SerialArm, HasTheJacobianOfItsForwardKinematics) {
  support::Random random(12);
  for (const SerialArm& arm : kArms) {
    for (int i = 0; i < kPoses; ++i) {
      const Eigen::Vector3d q = any_pose(arm, random);
      const Eigen::Matrix3d J_BT = arm.jacobian(q);
      for (int joint = 0; joint < 3; ++joint) {
        constexpr double kStep = 1e-5;
        Eigen::Vector3d plus = q, minus = q;
        plus[joint] += kStep;
        minus[joint] -= kStep;
        const Eigen::Vector3d column = (arm.forward(plus) - arm.forward(minus)) / (2 * kStep);
        // Central differences: h^2/6 times the third derivative (< 0.5 m), and rounding / h.
        EXPECT_LT((J_BT.col(joint) - column).norm(), 5e-11) << q.transpose();
      }
    }
  }
}

TEST(SerialArm, TipAndJointVirtualWorkAreEqual) {
  support::Random random(13);
  for (const SerialArm& arm : kArms) {
    for (int i = 0; i < kPoses; ++i) {
      const Eigen::Vector3d q = any_pose(arm, random);
      const Eigen::Vector3d qdot = random.in_box(3);
      const Eigen::Vector3d f_T_B = random.in_box(8.5);
      constexpr double kStep = 1e-6;
      // The tip's velocity from the geometry only, not from the Jacobian under test.
      const Eigen::Vector3d v_BT =
          (arm.forward(q + kStep * qdot) - arm.forward(q - kStep * qdot)) / (2 * kStep);
      const Eigen::Vector3d tau = arm.jacobian(q).transpose() * f_T_B;
      EXPECT_NEAR(tau.dot(qdot), f_T_B.dot(v_BT), 1e-8) << q.transpose();
    }
  }
}

TEST(SerialArm, CombinedPoseEqualsSeparateResults) {
  support::Random random(14);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d q = any_pose(kArms[1], random);
    Eigen::Vector3d p_BT;
    Eigen::Matrix3d J_BT;
    kArms[1].forward(q, p_BT, J_BT);
    EXPECT_EQ(p_BT, kArms[1].forward(q));
    EXPECT_EQ(J_BT, kArms[1].jacobian(q));
  }
}

TEST(SerialArm, UnreachablePointsHaveNoJoints) {
  const SerialArm& arm = kArms[0];
  EXPECT_FALSE(arm.inverse({0.2501, 0, 0}));  // longer than both links
  EXPECT_FALSE(arm.inverse({0.0259, 0, 0}));  // closer than their difference
  EXPECT_FALSE(arm.inverse({0, 0, 0.2}));     // on the yaw axis
  EXPECT_FALSE(arm.inverse({NAN, 0, 0}));
  EXPECT_FALSE(arm.inverse({0.1, INFINITY, 0}));
  EXPECT_TRUE(arm.inverse({0.2499, 0, 0}));
}

}  // namespace
}  // namespace thimble::driver
