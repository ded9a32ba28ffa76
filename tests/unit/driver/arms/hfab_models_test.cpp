#include "arms/hfab/hfab_models.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "arms/hfab/hfab_wire.h"
#include "arms/woody/woody_wire.h"
#include "support/random.h"

namespace thimble::driver::hfab {
namespace {

/// Compares the Jacobian with central differences around a pose; returns the largest difference
/// relative to the Jacobian.
template <class Geometry>
double worst_jacobian_error(const Geometry& geometry, const Eigen::Vector3d& q) {
  constexpr double kStep = 1e-6;  // rad
  Eigen::Vector3d p, p_up, p_down;
  Eigen::Matrix3d J, ignored, differences;
  geometry.forward(q, p, J);
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(k);
    geometry.forward(q + step, p_up, ignored);
    geometry.forward(q - step, p_down, ignored);
    differences.col(k) = (p_up - p_down) / (2 * kStep);
  }
  return (J - differences).norm() / J.norm();
}

/// Draws joint angles at which the linkage closes, at least 8 degrees from its stretched pose.
Eigen::Vector3d polhem_angles(support::Random& random) {
  const LinkageArm arm = polhem_model().geometry;
  for (;;) {
    const Eigen::Vector3d q{random.uniform(-1, 1), random.uniform(0.5, 2.2),
                            random.uniform(2.0, 4.4)};
    const Eigen::Vector2d bar(
        arm.length_0 + arm.length_1 * std::cos(q[1]) - arm.length_2 * std::cos(q[2]),
        arm.length_1 * std::sin(q[1]) - arm.length_2 * std::sin(q[2]));
    const double distance = bar.norm();
    const double cosine =
        (distance * distance + arm.length_4 * arm.length_4 - arm.length_3 * arm.length_3) /
        (2 * arm.length_4 * distance);
    if (std::abs(cosine) < 0.99) return q;
  }
}

TEST(HfabModels, PolhemHasTheJacobianOfCentralDifferences) {
  const auto model = polhem_model();
  support::Random random(91);
  for (int i = 0; i < 2000; ++i) {
    EXPECT_LT(worst_jacobian_error(model.geometry, polhem_angles(random)), 1e-6);
  }
}

TEST(HfabModels, PolhemInvertsEveryReachablePlace) {
  const LinkageArm arm = polhem_model().geometry;
  const Eigen::Vector3d middle(0.2045, 0, 0.0325);  // of the workspace [S forsslund/hfabapi]
  support::Random random(93);
  int reached = 0;
  for (int i = 0; i < 5000; ++i) {
    const Eigen::Vector3d p_BT = middle + random.in_box(0.08);
    const auto q = arm.inverse(p_BT);
    if (!q) continue;
    Eigen::Vector3d p;
    Eigen::Matrix3d J;
    arm.forward(*q, p, J);
    ASSERT_LT((p - p_BT).norm(), 1e-12);
    // The same assembly mode everywhere: a small step of the tip is a small step of the angles, as
    // the Jacobian predicts, except at the very edge of reach.
    const Eigen::Vector3d step(1e-6, -1e-6, 1e-6);
    const Eigen::Vector3d turn = J.inverse() * step;
    const auto next = arm.inverse(p_BT + step);
    if (!next || turn.norm() > 1e-4) continue;
    ASSERT_LT((*next - *q - turn).norm(), 0.01 * turn.norm());
    ++reached;
  }
  EXPECT_GT(reached, 4500);
  EXPECT_FALSE(arm.inverse({0.6, 0, 0}));
  EXPECT_FALSE(arm.inverse({NAN, 0, 0}));
  // Parked, all counters are zero.
  const auto model = polhem_model();
  const Eigen::Vector3d q_parked = model.joint_angles({});
  Eigen::Vector3d p_parked;
  Eigen::Matrix3d J;
  arm.forward(q_parked, p_parked, J);
  ASSERT_TRUE(arm.inverse(p_parked));
  EXPECT_LT((*arm.inverse(p_parked) - q_parked).norm(), 1e-9);
}

TEST(HfabModels, PolhemClosesItsLinkage) {
  const auto model = polhem_model();
  const LinkageArm& arm = model.geometry;
  support::Random random(92);
  for (int i = 0; i < 2000; ++i) {
    Eigen::Vector3d q = polhem_angles(random), p;
    q[0] = 0;
    Eigen::Matrix3d J;
    arm.forward(q, p, J);
    const Eigen::Vector2d elbow(arm.length_0 / 2 + arm.length_1 * std::cos(q[1]),
                                arm.length_1 * std::sin(q[1]));
    const Eigen::Vector2d crank(-arm.length_0 / 2 + arm.length_2 * std::cos(q[2]),
                                arm.length_2 * std::sin(q[2]));
    const Eigen::Vector2d forearm = Eigen::Vector2d(p.x(), p.z()) - elbow;
    EXPECT_NEAR(forearm.norm(), arm.length_5, 1e-12);
    EXPECT_NEAR((elbow - forearm * (arm.length_4 / arm.length_5) - crank).norm(), arm.length_3,
                1e-12);
  }
}

TEST(HfabModels, PolhemHomeMatchesThePublishedLibrary) {
  // hfab_polhem.h evaluated at the home counts of hfab_api.cpp: yaw 2.102 rad, reach 35.80 mm,
  // height 69.55 mm.
  Eigen::Vector3d p;
  Eigen::Matrix3d J;
  const auto model = polhem_model();
  model.geometry.forward(model.joint_angles({}), p, J);
  EXPECT_NEAR(std::hypot(p.x(), p.y()), 0.03580, 2e-5);
  EXPECT_NEAR(p.z(), 0.06955, 2e-5);
  EXPECT_NEAR(std::atan2(p.y(), p.x()), 2.102, 1e-3);
}

TEST(HfabModels, PolhemHasNoPoseIfItsBarsCannotMeet) {
  Eigen::Vector3d p;
  Eigen::Matrix3d J;
  polhem_model().geometry.forward({0, 0, std::numbers::pi}, p, J);
  EXPECT_FALSE(p.squaredNorm() < HUGE_VAL);
  EXPECT_FALSE(J.squaredNorm() < HUGE_VAL);
}

TEST(HfabModels, WoodenHapticsHasItsPublishedHomeAndResolution) {
  const woody::WoodyArm arm(woody_model());
  const ArmPose home = arm.pose({});
  EXPECT_LT((home.q - Eigen::Vector3d(0, 0, std::numbers::pi / 2)).norm(), 1e-12);
  EXPECT_LT((home.p_BT - Eigen::Vector3d(0.245, 0, 0.285)).norm(), 1e-12);
  // DEVICES.md: 0.043, 0.054, 0.064 mm per count; the first where r is 0.22 m.
  const double at_origin = 0.220 * arm.model().step(0) * 1e3;
  EXPECT_NEAR(at_origin, 0.043, 0.0005);
  EXPECT_NEAR(0.205 * arm.model().step(1) * 1e3, 0.054, 0.0005);
  EXPECT_NEAR(0.245 * arm.model().step(2) * 1e3, 0.064, 0.0005);
}

// A board of the mbed generation, with the signs of both published clients of its 8-byte reports:
// CHAI3D's CWoodenDevice.cpp (encoder values {-a, b, c}, gear ratios {+16, -12, +12}, C from a
// right angle downwards, motor torques {+A, -B, -C}) and haptikfabrikenapi (all encoders reversed,
// motor A positive).
TEST(HfabModels, MbedEncoderATurnsWoodenHapticsLeft) {
  const woody::WoodyArm arm(woody_model(WoodyBoard::kMbed));
  const double step_a = 2 * std::numbers::pi / (2000 * 16);
  const double step_b = 2 * std::numbers::pi / (2000 * 12);
  const double a = -1000 * step_a, b = -500 * step_b, c = std::numbers::pi / 2 - 300 * step_b;
  const double r = 0.205 * std::sin(b) + 0.245 * std::sin(c);
  const Eigen::Vector3d published(r * std::cos(a), r * std::sin(a),
                                  0.080 + 0.205 * std::cos(b) - 0.245 * std::cos(c));
  ArmReading reading;
  reading.counts = {1000, 500, 300};
  EXPECT_LT((arm.pose(reading).p_BT - published).norm(), 1e-12);
  EXPECT_LT(arm.pose(reading).p_BT.y(), -0.01);
  EXPECT_EQ(arm.drives()[0].sign, 1);
  EXPECT_EQ(arm.drives()[1].sign, -1);
  EXPECT_EQ(arm.drives()[2].sign, -1);
  EXPECT_EQ(arm.drives()[0].current_max, 3);
}

TEST(HfabModels, TextEncoderATurnsWoodenHapticsRight) {
  const auto arm = make_line_arm(3);
  ArmReading reading;
  reading.counts = {1000, 0, 0};
  EXPECT_GT(arm->pose(reading).p_BT.y(), 0.01);
  EXPECT_EQ(arm->drives()[0].sign, 1);
}

TEST(HfabModels, ChooseTheGeometryByTheModelNumber) {
  for (const std::int32_t number : {1, 2, 3}) {
    const auto arm = make_line_arm(number);
    ASSERT_TRUE(arm) << number;
    EXPECT_LT(arm->pose({}).p_BT.norm(), 0.5);
  }
  EXPECT_NEAR(make_line_arm(3)->drives()[0].current_max, 6, 0);
  EXPECT_EQ(make_line_arm(0), nullptr);
  EXPECT_EQ(make_line_arm(4), nullptr);
}

TEST(HfabModels, RejectAnAnswerWithOldCounts) {
  std::array<std::byte, kLineCapacity> bytes{};
  ArmReading reading;
  for (const std::int32_t error : {8, 128, 256, 512, 1024, 1032}) {
    const std::size_t size = encode_arm_line({.model = 3, .counts = {9}, .error = error}, bytes);
    EXPECT_FALSE(LineWire::decode(std::span(bytes).first(size), reading)) << error;
  }
  EXPECT_EQ(reading.counts[0], 0);
  const std::size_t size = encode_arm_line({.model = 3, .counts = {9}, .error = 2}, bytes);
  EXPECT_TRUE(
      LineWire::decode(std::span(bytes).first(size), reading));  // only a gimbal sensor differs
  EXPECT_EQ(reading.counts[0], 9);
}

}  // namespace
}  // namespace thimble::driver::hfab
