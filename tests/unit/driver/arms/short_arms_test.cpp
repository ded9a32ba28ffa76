#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <array>
#include <cmath>
#include <numbers>

#include "support/random.h"
#include "thimble/driver/arm_model.h"
#include "thimble/driver/wire_arm.h"

// Geometries of arms with one to three motors: paddle, five-bar, straight axes.
namespace thimble::driver {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Generations of the Haply 2DIY, and a five-bar with four different links, m.
const std::array<FiveBarArm, 4> kFiveBars{{
    {.base = 0.02, .crank_1 = 0.05, .crank_2 = 0.05, .distal_1 = 0.07, .distal_2 = 0.07},
    {.base = 0, .crank_1 = 0.07, .crank_2 = 0.07, .distal_1 = 0.09, .distal_2 = 0.09},
    {.base = 0.038, .crank_1 = 0.07, .crank_2 = 0.07, .distal_1 = 0.09, .distal_2 = 0.09},
    {.base = 0.03, .crank_1 = 0.06, .crank_2 = 0.075, .distal_1 = 0.085, .distal_2 = 0.1},
}};

template <class Geometry>
Matrix3d jacobian_of(const Geometry& arm, const Vector3d& q) {
  Vector3d p;
  Matrix3d J;
  arm.forward(q, p, J);
  return J;
}

template <class Geometry>
Vector3d tip_of(const Geometry& arm, const Vector3d& q) {
  Vector3d p;
  Matrix3d J;
  arm.forward(q, p, J);
  return p;
}

/// Returns the largest difference to central differences, relative to the Jacobian.
template <class Geometry>
double jacobian_error(const Geometry& arm, const Vector3d& q) {
  constexpr double kStep = 1e-6;  // rad
  Matrix3d differences;
  for (int k = 0; k < 3; ++k) {
    const Vector3d step = kStep * Vector3d::Unit(k);
    differences.col(k) = (tip_of(arm, q + step) - tip_of(arm, q - step)) / (2 * kStep);
  }
  const Matrix3d J = jacobian_of(arm, q);
  return (J - differences).norm() / J.norm();
}

/// Draws angles of a five-bar that are not singular.
Vector3d regular_angles(const FiveBarArm& arm, support::Random& random) {
  for (;;) {
    const Vector3d q(random.uniform(-4, 4), random.uniform(-4, 4), 0);
    if (arm.configuration(q) == FiveBarPose::kRegular) return q;
  }
}

TEST(FiveBar, HasTheJacobianOfCentralDifferences) {
  support::Random random(531);
  for (const FiveBarArm& arm : kFiveBars) {
    for (int i = 0; i < 2000; ++i) {
      EXPECT_LT(jacobian_error(arm, regular_angles(arm, random)), 1e-6);
    }
  }
}

TEST(FiveBar, ClosesItsBars) {
  support::Random random(532);
  for (const FiveBarArm& arm : kFiveBars) {
    for (int i = 0; i < 2000; ++i) {
      const Vector3d q = regular_angles(arm, random), p = tip_of(arm, q);
      const Vector3d elbow_1 =
          arm.crank_1 * Vector3d(std::cos(q[0]), std::sin(q[0]), 0) - Vector3d(arm.base / 2, 0, 0);
      const Vector3d elbow_2 =
          arm.crank_2 * Vector3d(std::cos(q[1]), std::sin(q[1]), 0) + Vector3d(arm.base / 2, 0, 0);
      EXPECT_NEAR((p - elbow_1).norm(), arm.distal_1, 1e-12);
      EXPECT_NEAR((p - elbow_2).norm(), arm.distal_2, 1e-12);
      EXPECT_GT((elbow_2 - elbow_1).cross(p - elbow_1).z(), 0);
    }
  }
}

// Virtual work: the torques of a force do its work, tau dq = f dx, for real (not infinitesimal)
// motions in small steps.
TEST(FiveBar, TorquesDoTheWorkOfTheForce) {
  support::Random random(533);
  for (const FiveBarArm& arm : kFiveBars) {
    for (int path = 0; path < 20; ++path) {
      const Vector3d from(random.uniform(-0.02, 0.02), random.uniform(0.06, 0.08), 0);
      const Vector3d to(random.uniform(-0.02, 0.02), random.uniform(0.06, 0.08), 0);
      const Vector3d f(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
      double work = 0;
      constexpr int kSteps = 1000;
      auto q = arm.inverse(from);
      ASSERT_TRUE(q);
      for (int i = 1; i <= kSteps; ++i) {
        const auto next = arm.inverse(from + (to - from) * i / kSteps);
        ASSERT_TRUE(next);
        const Vector3d tau = jacobian_of(arm, (*q + *next) / 2).transpose() * f;
        work += tau.dot(*next - *q);
        q = next;
      }
      EXPECT_NEAR(work, f.dot(to - from), 1e-9);
    }
  }
}

TEST(FiveBar, InvertsEveryReachablePoint) {
  support::Random random(534);
  for (const FiveBarArm& arm : kFiveBars) {
    int reached = 0;
    for (int i = 0; i < 3000; ++i) {
      const Vector3d p(random.uniform(-0.15, 0.15), random.uniform(-0.05, 0.17), 0);
      const auto q = arm.inverse(p);
      if (!q) continue;
      ASSERT_LT((tip_of(arm, *q) - p).norm(), 1e-12);
      ++reached;
    }
    EXPECT_GT(reached, 500);
  }
}

TEST(FiveBar, HasTheHomeTipsOfThe2Diy) {
  constexpr double kDegree = std::numbers::pi / 180;
  // MAKERS.md, from the first motor: (0, 22.1) and (19.0, 35.7) mm.
  EXPECT_LT(
      (tip_of(kFiveBars[1], {241 * kDegree, -61 * kDegree, 0}) - Vector3d(0, 0.0221, 0)).norm(),
      5e-5);
  EXPECT_LT(
      (tip_of(kFiveBars[2], {168 * kDegree, 12 * kDegree, 0}) - Vector3d(0, 0.0357, 0)).norm(),
      5e-5);
  // The inverse solution is the pose in which they are built, without a turn more or less.
  const auto home = kFiveBars[1].inverse(tip_of(kFiveBars[1], {241 * kDegree, -61 * kDegree, 0}));
  ASSERT_TRUE(home);
  EXPECT_LT((*home - Vector3d(241 * kDegree, -61 * kDegree, 0)).norm(), 1e-9);
}

TEST(FiveBar, NamesItsSingularPoses) {
  const FiveBarArm arm{
      .base = 0.04, .crank_1 = 0.07, .crank_2 = 0.07, .distal_1 = 0.09, .distal_2 = 0.09};
  const auto name_at = [&](double q_1, double q_2) {
    return name(arm.configuration({q_1, q_2, 0}));
  };
  constexpr double kHalfTurn = std::numbers::pi;
  EXPECT_EQ(name_at(2.5, kHalfTurn - 2.5), "regular");
  // The elbows are nearly 0.18 m apart, as far as the distal links reach.
  EXPECT_EQ(name_at(kHalfTurn - 0.01, 0.01), "distal links stretched");
  // Both elbows at one point: cos q = 0.02 / 0.07.
  const double meet = std::acos(0.02 / 0.07);
  EXPECT_EQ(name_at(meet, kHalfTurn - meet), "distal links folded");
  // Longer cranks cannot be bridged.
  const FiveBarArm wide{
      .base = 0.06, .crank_1 = 0.07, .crank_2 = 0.07, .distal_1 = 0.09, .distal_2 = 0.09};
  EXPECT_EQ(name(wide.configuration({kHalfTurn, 0, 0})), "distal links do not meet");
  // The tip as far from motor 1 as crank and distal link reach together.
  const auto straight = arm.inverse({-0.02 + 0.15998 * std::cos(1.2), 0.15998 * std::sin(1.2), 0});
  ASSERT_TRUE(straight);
  EXPECT_EQ(name(arm.configuration(*straight)), "crank and distal link in line");
}

TEST(FiveBar, GivesNoPoseIfItsBarsCannotMeet) {
  const FiveBarArm wide{
      .base = 0.06, .crank_1 = 0.07, .crank_2 = 0.07, .distal_1 = 0.09, .distal_2 = 0.09};
  EXPECT_FALSE(tip_of(wide, {std::numbers::pi, 0, 0}).squaredNorm() < HUGE_VAL);
  EXPECT_FALSE(jacobian_of(wide, {std::numbers::pi, 0, 0}).squaredNorm() < HUGE_VAL);
  EXPECT_FALSE(tip_of(wide, {NAN, 0, 0}).squaredNorm() < HUGE_VAL);
}

TEST(FiveBar, RefusesPointsOutOfReach) {
  for (const FiveBarArm& arm : kFiveBars) {
    EXPECT_FALSE(arm.inverse({0, 0.3, 0}));
    EXPECT_FALSE(arm.inverse({0, 0.07, 1e-6}));
    EXPECT_FALSE(arm.inverse({NAN, 0.07, 0}));
    EXPECT_FALSE(arm.inverse({0, HUGE_VAL, 0}));
    EXPECT_TRUE(arm.inverse({0, 0.07, 1e-12}));
  }
}

TEST(Paddle, HasTheJacobianOfItsHandle) {
  const PaddleArm arm{.handle = 0.09};
  EXPECT_LT(jacobian_error(arm, {0.3, 0, 0}), 1e-9);
  EXPECT_NEAR(jacobian_of(arm, {0.3, 0, 0})(0, 0), 0.09, 0);
}

// Published: x = r_h (r_p / r_s) times the motor's angle, torque of the motor f r_h r_p / r_s.
TEST(Paddle, AgreesWithThePublishedHapkit) {
  constexpr double kHandle = 0.09, kPulley = 0.005, kSector = 0.074;
  JointModel<PaddleArm> model{.geometry = {.handle = kHandle}, .drives = {}, .encoders = {}};
  model.drives = {MotorDrive{.ratio = kSector / kPulley, .torque_constant = 1, .current_max = 1},
                  absent_motor(), absent_motor()};
  model.encoders = {JointEncoder{.counts_per_motor_turn = 1000}, absent_encoder(),
                    absent_encoder()};
  ArmReading reading;
  reading.counts = {250, 123, -456};  // a quarter of a turn; the others are not connected
  const Vector3d q = model.joint_angles(reading), p = tip_of(model.geometry, q);
  EXPECT_NEAR(p.x(), kHandle * kPulley / kSector * std::numbers::pi / 2, 1e-12);
  EXPECT_EQ(p.y(), 0);
  EXPECT_EQ(p.z(), 0);
  const Vector3d tau = jacobian_of(model.geometry, q).transpose() * Vector3d(2, 0, 0);
  EXPECT_NEAR(tau[0] / model.drives[0].ratio, 2 * kHandle * kPulley / kSector, 1e-12);
}

TEST(Paddle, InvertsItsLineOnly) {
  const PaddleArm arm{.handle = 0.09};
  for (const double x : {-0.2, -0.01, 0.0, 0.05}) {
    const auto q = arm.inverse({x, 0, 0});
    ASSERT_TRUE(q);
    EXPECT_NEAR(tip_of(arm, *q).x(), x, 1e-15);
  }
  EXPECT_FALSE(arm.inverse({0.3, 0, 0}));  // beyond half a turn
  EXPECT_FALSE(arm.inverse({0, 1e-6, 0}));
  EXPECT_FALSE(arm.inverse({0, 0, -1e-6}));
  EXPECT_FALSE(arm.inverse({NAN, 0, 0}));
}

TEST(Cartesian, HasADiagonalJacobian) {
  const CartesianArm arm{.radius = {0.01, 0.02, 0.03}, .axes = 3};
  EXPECT_LT(jacobian_error(arm, {0.3, -0.2, 5}), 1e-9);
  const auto q = arm.inverse({0.1, 0.2, -0.3});
  ASSERT_TRUE(q);
  EXPECT_LT((tip_of(arm, *q) - Vector3d(0.1, 0.2, -0.3)).norm(), 1e-15);
}

TEST(Cartesian, InvertsPointsOnItsAxesOnly) {
  const CartesianArm plane{.radius = {0.01, 0.02, 1}, .axes = 2};
  EXPECT_TRUE(plane.inverse({0.1, 0.2, 0}));
  EXPECT_FALSE(plane.inverse({0.1, 0.2, 1e-6}));
  const CartesianArm line{.radius = {0.01, 1, 1}, .axes = 1};
  EXPECT_TRUE(line.inverse({0.1, 0, 0}));
  EXPECT_FALSE(line.inverse({0.1, 1e-6, 0}));
  EXPECT_FALSE(line.inverse({NAN, 0, 0}));
}

TEST(ShortArms, CountTheirMotors) {
  EXPECT_EQ(motor_count(ArmGeometry(SerialArm())), 3);
  EXPECT_EQ(motor_count(ArmGeometry(LinkageArm())), 3);
  EXPECT_EQ(motor_count(ArmGeometry(PaddleArm())), 1);
  EXPECT_EQ(motor_count(ArmGeometry(FiveBarArm())), 2);
  EXPECT_EQ(motor_count(ArmGeometry(CartesianArm{.axes = 2})), 2);
  EXPECT_EQ(free_axes(1), Vector3d(1, 0, 0));
  EXPECT_EQ(free_axes(2), Vector3d(1, 1, 0));
  EXPECT_EQ(free_axes(3), Vector3d(1, 1, 1));
}

}  // namespace
}  // namespace thimble::driver
