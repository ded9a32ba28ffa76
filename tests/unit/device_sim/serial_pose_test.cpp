#include "plant/serial_pose.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "plant/plant.h"
#include "support/random.h"

namespace thimble::device_sim {
namespace {

TEST(SerialPose, MatchesTheDriverOverTheWholeWorkspace) {
  const driver::SerialArm arm{.height = 0.05, .length_b = 0.138, .length_c = 0.112};
  support::Random random(8);
  int reached = 0;
  for (int i = 0; i < 20000; ++i) {
    const Eigen::Vector3d p_BT = random.in_box(0.27);
    const SerialPose pose(arm, p_BT);
    const auto q = arm.inverse(p_BT);
    ASSERT_EQ(pose.within_reach(), q.has_value()) << p_BT.transpose();
    if (!q) continue;
    const double sin_sum = std::sin((*q)[1] + (*q)[2]);
    const double r = std::hypot(p_BT.x(), p_BT.y());
    if (sin_sum < SerialPose::kSingular || r < SerialPose::kSingular * arm.length_b) continue;
    ++reached;
    for (int axis = 0; axis < 3; ++axis) {
      const double difference = pose.angles()[axis] - (*q)[axis];
      ASSERT_NEAR(std::remainder(difference, 2 * std::numbers::pi), 0, 1e-13);
    }
    const Eigen::Vector3d tau = random.in_box(1);
    const Eigen::Vector3d back = arm.jacobian(*q).transpose() * pose.force_from(tau);
    ASSERT_LT((back - tau).norm(), 1e-11) << p_BT.transpose();
  }
  EXPECT_GT(reached, 5000);
}

TEST(SerialPose, FindsItsAnglesFromANearbyPose) {
  const driver::SerialArm arm{.height = 0.05, .length_b = 0.138, .length_c = 0.112};
  support::Random random(9);
  int found = 0, refused = 0;
  for (int i = 0; i < 50000; ++i) {
    const Eigen::Vector3d p_BT = random.in_box(0.25);
    const double far = std::pow(10, random.uniform(-7, -1.5));
    const SerialPose from(arm, p_BT), pose(arm, p_BT + random.in_box(far));
    if (!from.within_reach() || !pose.within_reach()) continue;
    Eigen::Vector3d q;
    if (!pose.angles_near(from, from.angles(), q)) {
      ++refused;
      continue;
    }
    ++found;
    ASSERT_LT((q - pose.angles()).cwiseAbs().maxCoeff(), Plant::kAboutError) << p_BT.transpose();
  }
  EXPECT_GT(found, 5000);
  EXPECT_GT(refused, 100);
}

TEST(SerialPose, KeepsForcesBoundedAtTheEdgesOfReach) {
  const driver::SerialArm arm{.height = 0, .length_b = 0.138, .length_c = 0.112};
  const Eigen::Vector3d tau(1, 1, 1);
  for (const double gap : {1e-3, 1e-6, 1e-9, 1e-12, 1e-15}) {
    for (const Eigen::Vector3d& p_BT :
         {Eigen::Vector3d(0.25 - gap, 0, 0), Eigen::Vector3d(0.026 + gap, 0, 0),
          Eigen::Vector3d(gap, 0, 0.15), Eigen::Vector3d(0, gap, -0.1)}) {
      const SerialPose pose(arm, p_BT);
      if (!pose.within_reach()) continue;
      const double force = pose.force_from(tau).norm();
      EXPECT_LE(force, 4 * tau.norm() / (0.112 * SerialPose::kSingular)) << p_BT.transpose();
    }
  }
  EXPECT_FALSE(SerialPose(arm, {std::numeric_limits<double>::quiet_NaN(), 0, 0}).within_reach());
  EXPECT_FALSE(SerialPose(arm, {0, 0, 0.1}).within_reach());
}

}  // namespace
}  // namespace thimble::device_sim
