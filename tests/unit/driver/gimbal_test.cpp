#include "thimble/driver/orientation.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "arm_table.h"
#include "arms/falcon/falcon_arm.h"
#include "arms/hfab/hfab_models.h"
#include "support/random.h"
#include "support/vintage_arm.h"

namespace thimble::driver {
namespace {

using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Vector3d;

Gimbal published_gimbal() {
  return {.axes = {FrameAxis::kX, FrameAxis::kY, FrameAxis::kX},
          .sign = {-1, -1, 1},
          .counts_per_turn = {1024, 1024, 1024},
          .home_counts = {0, 30, 0}};
}

TEST(Gimbal, TurnsCountsIntoAnglesAndBack) {
  const Gimbal gimbal = published_gimbal();
  EXPECT_EQ(gimbal.angles({0, -30, 0}), Vector3d(0, 0, 0));
  EXPECT_NEAR(gimbal.angles({256, -30, 0})[0], -std::numbers::pi / 2, 1e-15);
  support::Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const Vector3d angles = random.in_box(3);
    const Vector3d counts = gimbal.exact_counts(angles);
    std::array<std::int32_t, 3> whole{};
    for (std::size_t k = 0; k < 3; ++k) {
      whole[k] = static_cast<std::int32_t>(std::lround(counts[static_cast<Eigen::Index>(k)]));
    }
    EXPECT_LE((gimbal.angles(whole) - angles).cwiseAbs().maxCoeff(),
              std::numbers::pi / 1024 + 1e-12);
  }
}

TEST(Gimbal, TurnsAboutItsAxesOneAfterTheOther) {
  support::Random random(2);
  for (int i = 0; i < 100; ++i) {
    const Vector3d a = random.in_box(3);
    const Matrix3d expected =
        (AngleAxisd(a[0], Vector3d::UnitZ()) * AngleAxisd(a[1], Vector3d::UnitY()) *
         AngleAxisd(a[2], Vector3d::UnitX()))
            .toRotationMatrix();
    const Gimbal gimbal{.axes = {FrameAxis::kZ, FrameAxis::kY, FrameAxis::kX}};
    EXPECT_LT((gimbal.rotation(a) - expected).norm(), 1e-14);
  }
}

/// Returns the direction of the last link: the direction in which the tip moves if the link is made
/// longer.
template <class Geometry>
Vector3d direction(const Geometry& arm, double Geometry::*last, const Vector3d& q) {
  Geometry longer = arm;
  longer.*last += 0.01;
  Vector3d p, p_longer;
  Matrix3d J;
  arm.forward(q, p, J);
  longer.forward(q, p_longer, J);
  return (p_longer - p).normalized();
}

TEST(Gimbal, LastLinkFrameHasXToTheTipAndYLevel) {
  support::Random random(3);
  const auto vintage = support::vintage_model();
  const auto polhem = hfab::polhem_model();
  const auto check = [](const Matrix3d& R_BL, const Vector3d& along) {
    EXPECT_LT((R_BL.transpose() * R_BL - Matrix3d::Identity()).norm(), 1e-12);
    EXPECT_NEAR(R_BL.determinant(), 1, 1e-12);
    EXPECT_LT((R_BL.col(0) - along).norm(), 1e-9);
    EXPECT_NEAR(R_BL(2, 1), 0, 1e-12);
  };
  for (int i = 0; i < 500; ++i) {
    Vector3d q = support::vintage_home() + random.in_box(0.6), p;
    Matrix3d J;
    vintage.geometry.forward(q, p, J);
    check(vintage.geometry.last_link(q, p), direction(vintage.geometry, &SerialArm::length_c, q));
    q = polhem.joint_angles({}) + random.in_box(0.3);
    polhem.geometry.forward(q, p, J);
    if (!p.allFinite()) continue;
    check(polhem.geometry.last_link(q, p), direction(polhem.geometry, &LinkageArm::length_5, q));
  }
  EXPECT_EQ(falcon::falcon_geometry().last_link({}, {}), Matrix3d(Matrix3d::Identity()));
}

TEST(Gimbal, PolhemGimbalMatchesThePublishedLibrary) {
  // R = rot_z(tA) rot_y(-lambda) rot_x(tD) rot_y(tE) rot_x(tF), lambda: climb of the forearm [S
  // hfabapi hfab_api.cpp, getRot].
  ArmModel model = arm_model(hfab::polhem_model());
  model.gimbal = published_gimbal();
  support::Random random(4);
  for (const ArmKind kind : {ArmKind::kPolhem, ArmKind::kHfabLine}) {
    const auto arm = make_arm(kind, model);
    ASSERT_TRUE(arm->has_gimbal());
    int compared = 0;
    for (int i = 0; i < 200; ++i) {
      ArmReading reading;
      for (auto& count : reading.counts)
        count = static_cast<std::int32_t>(random.uniform(-800, 800));
      for (auto& count : reading.auxiliary) {
        count = static_cast<std::int32_t>(random.uniform(-400, 400));
      }
      const ArmPose pose = arm->pose(reading);
      if (!pose.p_BT.allFinite()) continue;  // its bars cannot meet in this pose
      const LinkageArm& g = std::get<LinkageArm>(model.geometry);
      const Vector3d out(std::cos(pose.q[0]), std::sin(pose.q[0]), 0);
      const Vector3d elbow = (g.length_0 / 2 + g.length_1 * std::cos(pose.q[1])) * out +
                             g.length_1 * std::sin(pose.q[1]) * Vector3d::UnitZ();
      const Vector3d forearm = pose.p_BT - elbow;
      const double lambda = std::atan2(forearm.z(), forearm.dot(out));
      constexpr double kTurn = 2 * std::numbers::pi;
      const double tD = -kTurn * reading.auxiliary[0] / 1024;
      const double tE = -kTurn * (reading.auxiliary[1] + 30) / 1024;
      const double tF = kTurn * reading.auxiliary[2] / 1024;
      const Matrix3d published =
          (AngleAxisd(pose.q[0], Vector3d::UnitZ()) * AngleAxisd(-lambda, Vector3d::UnitY()) *
           AngleAxisd(tD, Vector3d::UnitX()) * AngleAxisd(tE, Vector3d::UnitY()) *
           AngleAxisd(tF, Vector3d::UnitX()))
              .toRotationMatrix();
      Vector3d angles;
      Matrix3d R_BT;
      arm->orient(reading, pose, angles, R_BT);
      ASSERT_LT((R_BT - published).norm(), 1e-12);
      ++compared;
    }
    EXPECT_GT(compared, 100);
  }
}

TEST(Gimbal, ArmWithoutGimbalLeavesOrientationUnchanged) {
  const auto arm = make_arm(ArmKind::kPolhem, arm_model(hfab::polhem_model()));
  EXPECT_FALSE(arm->has_gimbal());
  Vector3d angles(1, 2, 3);
  Matrix3d R_BT = Matrix3d::Zero();
  arm->orient({}, {}, angles, R_BT);
  EXPECT_EQ(angles, Vector3d(1, 2, 3));
  EXPECT_EQ(R_BT, Matrix3d(Matrix3d::Zero()));
}

TEST(Orientation, QuaternionRoundTripKeepsEveryStep) {
  support::Random random(5);
  for (int i = 0; i < 1000; ++i) {
    const Matrix3d R =
        AngleAxisd{random.uniform(-3.14, 3.14), random.in_box(1).normalized()}.toRotationMatrix();
    const TipQuaternion q = quaternion_of(R);
    EXPECT_LT((rotation_of(q) - R).norm(), 1e-6);
    EXPECT_GE(q[0], 0);
    // The recorded quaternion gives exactly the matrix that the law got.
    EXPECT_EQ(rotation_of(q), rotation_of(TipQuaternion(q)));
  }
  EXPECT_EQ(quaternion_of(Matrix3d::Constant(NAN)), TipQuaternion{});
  EXPECT_EQ(rotation_of({}), Matrix3d(Matrix3d::Identity()));
}

}  // namespace
}  // namespace thimble::driver
