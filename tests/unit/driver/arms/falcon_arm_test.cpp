#include "arms/falcon/falcon_arm.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "support/dense_algebra.h"
#include "support/random.h"

namespace thimble::driver::falcon {
namespace {

class FalconGeometry : public ::testing::Test {
 protected:
  /// Draws points from the whole sphere, every fourth on its surface.
  Eigen::Vector3d anywhere() {
    const double radius = random_.bits() % 4 == 0 ? 1 : std::cbrt(random_.uniform(0, 1));
    return arm_.p_BM + kWorkspaceRadius * radius * random_.direction();
  }

  Eigen::Vector3d tip(const Eigen::Vector3d& q) const {
    Eigen::Vector3d p;
    Eigen::Matrix3d J;
    arm_.forward(q, p, J);
    return p;
  }

  const DeltaArm arm_ = falcon_geometry();
  support::Random random_{61};
};

TEST_F(FalconGeometry, ReachesItsWholeWorkspaceFarFromSingularPoses) {
  double worst = 1;
  for (int i = 0; i < 5000; ++i) {
    const auto q = arm_.inverse(arm_.p_BM + kWorkspaceRadius * random_.direction());
    ASSERT_TRUE(q);
    Eigen::Vector3d p;
    Eigen::Matrix3d J;
    arm_.forward(*q, p, J);
    const Eigen::Vector3d squares = support::symmetric_axes(J.transpose() * J).values;
    worst = std::max(worst, std::sqrt(squares[2] / squares[0]));
  }
  EXPECT_LT(worst, 4);
  EXPECT_FALSE(arm_.inverse(arm_.p_BM + Eigen::Vector3d(0, 0, 0.1)));
  EXPECT_FALSE(arm_.inverse({NAN, 0, 0.12}));
}

TEST_F(FalconGeometry, FindsTheTipFromAnyStart) {
  double worst = 0;
  int max_steps = 0;
  for (int i = 0; i < 20'000; ++i) {
    const Eigen::Vector3d p_true = anywhere();
    const auto q = arm_.inverse(p_true);
    ASSERT_TRUE(q) << p_true.transpose();
    Eigen::Vector3d p;
    Eigen::Matrix3d J;
    const int steps = arm_.forward_from(anywhere(), *q, p, J);
    ASSERT_GT(steps, 0) << p_true.transpose();
    worst = std::max(worst, (p - p_true).norm());
    max_steps = std::max(max_steps, steps);
  }
  EXPECT_LT(worst, 1e-9);
  std::printf("worst error %.3g m, most steps %d\n", worst, max_steps);
}

TEST_F(FalconGeometry, FindsTheTipFromTheAngles) {
  double worst = 0;
  for (int i = 0; i < 20'000; ++i) {
    const Eigen::Vector3d p_true = anywhere();
    const auto q = arm_.inverse(p_true);
    ASSERT_TRUE(q) << p_true.transpose();
    worst = std::max(worst, (tip(*q) - p_true).norm());
  }
  EXPECT_LT(worst, 1e-15);
}

TEST_F(FalconGeometry, HasTheJacobianOfCentralDifferences) {
  constexpr double kStep = 1e-5;  // rad
  double worst = 0;
  for (int i = 0; i < 2000; ++i) {
    const auto q = arm_.inverse(anywhere());
    ASSERT_TRUE(q);
    Eigen::Vector3d p;
    Eigen::Matrix3d J, differences;
    arm_.forward(*q, p, J);
    for (int k = 0; k < 3; ++k) {
      Eigen::Vector3d up = *q, down = *q;
      up[k] += kStep;
      down[k] -= kStep;
      differences.col(k) = (tip(up) - tip(down)) / (2 * kStep);
    }
    worst = std::max(worst, (J - differences).norm() / J.norm());
  }
  EXPECT_LT(worst, 1e-6);
  std::printf("worst relative difference %.3g\n", worst);
}

TEST_F(FalconGeometry, LegAndTipWorkAreEqual) {
  // f . v at the tip equals tau . qdot at the legs for any force and any motion.
  double worst = 0;
  for (int i = 0; i < 5000; ++i) {
    const auto q = arm_.inverse(anywhere());
    ASSERT_TRUE(q);
    Eigen::Vector3d p;
    Eigen::Matrix3d J;
    arm_.forward(*q, p, J);
    const Eigen::Vector3d f = 8 * random_.direction();
    const Eigen::Vector3d qdot = random_.in_box(3);
    const Eigen::Vector3d v = J * qdot;
    // Rates of the legs for a motion along v, by differences of fourth order of the closed-form
    // inverse; independent of the Jacobian.
    constexpr double kStep = 4e-5;  // m
    const auto q_at = [&](double times) {
      return *arm_.inverse(p + v * (times * kStep / v.norm()));
    };
    const Eigen::Vector3d qdot_measured =
        (8 * (q_at(1) - q_at(-1)) - (q_at(2) - q_at(-2))) / (12 * kStep) * v.norm();
    const double at_legs = (J.transpose() * f).dot(qdot_measured);
    worst = std::max(worst, std::abs(at_legs - f.dot(v)) / (f.norm() * v.norm()));
  }
  std::printf("worst relative difference of work %.3g\n", worst);
  EXPECT_LT(worst, 1e-9);
}

TEST_F(FalconGeometry, ExertsTheRequestedForceEverywhere) {
  const JointModel<DeltaArm> model = falcon_model();
  const FalconArm arm(model);
  double worst = 0, worst_on_wire = 0, quantum = 0;
  for (int i = 0; i < 5000; ++i) {
    const Eigen::Vector3d f = random_.direction();
    const auto q = arm_.inverse(anywhere());
    ASSERT_TRUE(q);
    Eigen::Vector3d p;
    Eigen::Matrix3d J;
    arm_.forward(*q, p, J);
    SafetyGate gate({.force_max = 8,
                     .speed_max = 10,
                     .rise_max = 1e9,
                     .soft_start = 1e-3,
                     .stall_ns = 1'000'000'000'000,
                     .watchdog_ns = 1'000'000'000'000});
    const MotorCurrents currents(gate.pass(f, {0, 0, 0}, 1), Eigen::Matrix3d::Identity(), J,
                                 model.drives);
    ASSERT_EQ(currents.scale(), 1) << p.transpose();
    // The force of the legs, from the motor values and the closed-form geometry: central
    // differences of the inverse give the inverse Jacobian, so f = (dq/dp)^T tau.
    constexpr double kStep = 1e-5;  // m
    Eigen::Matrix3d dq_dp;
    for (int k = 0; k < 3; ++k) {
      Eigen::Vector3d up = p, down = p;
      up[k] += kStep;
      down[k] -= kStep;
      dq_dp.col(k) = (*arm_.inverse(up) - *arm_.inverse(down)) / (2 * kStep);
    }
    const Eigen::Vector3d tau = -0.1 * currents.amperes();
    worst = std::max(worst, (dq_dp.transpose() * tau - f).norm());

    std::array<std::byte, kReportCapacity> bytes{};
    const std::size_t size = arm.encode(currents, bytes);
    const auto packet = decode_host_packet(std::span(bytes).first(size));
    ASSERT_TRUE(packet);
    const Eigen::Vector3d tau_on_wire =
        -1e-4 * Eigen::Vector3d(packet->motors[0], packet->motors[1], packet->motors[2]);
    worst_on_wire = std::max(worst_on_wire, (dq_dp.transpose() * tau_on_wire - f).norm());
    // Half a motor value in each leg.
    quantum = std::max(quantum, 0.5e-4 * dq_dp.cwiseAbs().colwise().sum().norm());
  }
  EXPECT_LT(worst, 1e-3);  // N of 1 N
  EXPECT_LT(worst_on_wire, quantum + 1e-3);
  std::printf("worst error of 1 N: %.3g N, with whole motor values %.3g N\n", worst, worst_on_wire);
}

TEST_F(FalconGeometry, HasTheTipResolutionOfItsGeometry) {
  // DEVICES 2: 9,880.7 counts per leg turn, 0.016 to 0.057 mm per count in the ball of 50 mm.
  const JointModel<DeltaArm> model = falcon_model();
  EXPECT_NEAR(2 * M_PI / model.step(0), 9880.7, 0.1);
  double least = 1, most = 0;
  for (int i = 0; i < 2000; ++i) {
    const auto q = arm_.inverse(anywhere());
    Eigen::Vector3d p;
    Eigen::Matrix3d J;
    arm_.forward(*q, p, J);
    for (int k = 0; k < 3; ++k) {
      least = std::min(least, J.col(k).norm() * model.step(0));
      most = std::max(most, J.col(k).norm() * model.step(0));
    }
  }
  std::printf("per count %.4f to %.4f mm\n", least * 1e3, most * 1e3);
  EXPECT_GT(least, 0.015e-3);
  EXPECT_LT(most, 0.058e-3);
}

TEST_F(FalconGeometry, PoseIsConsistentOrEmptyForAnyAngles) {
  int none = 0;
  for (int i = 0; i < 5000; ++i) {
    const Eigen::Vector3d q = random_.in_box(M_PI);
    Eigen::Vector3d p;
    Eigen::Matrix3d J;
    arm_.forward(q, p, J);
    if (!(p.squaredNorm() < HUGE_VAL)) {
      ++none;
      EXPECT_FALSE(J.squaredNorm() < HUGE_VAL);
      continue;
    }
    for (std::size_t leg = 0; leg < 3; ++leg) {
      const double cos_a = arm_.outwards[leg].x(), sin_a = arm_.outwards[leg].y();
      const auto k = static_cast<Eigen::Index>(leg);
      const double u = cos_a * p.x() + sin_a * p.y() - arm_.r + arm_.c - arm_.a * std::cos(q[k]);
      const double v = -sin_a * p.x() + cos_a * p.y() - arm_.s + arm_.f;
      const double w = p.z() - arm_.a * std::sin(q[k]);
      EXPECT_NEAR(std::hypot(std::hypot(u, w) - arm_.d - arm_.e, v), arm_.b, 1e-9);
    }
  }
  EXPECT_GT(none, 0);
  for (const Eigen::Vector3d& q : {Eigen::Vector3d(NAN, 0.6, 0.6), {INFINITY, 0.6, 0.6}}) {
    Eigen::Vector3d p;
    Eigen::Matrix3d J;
    arm_.forward(q, p, J);
    EXPECT_FALSE(p.squaredNorm() < HUGE_VAL);
    EXPECT_FALSE(J.squaredNorm() < HUGE_VAL);
  }
}

TEST_F(FalconGeometry, TurnsCountsIntoTheAnglesOfThePublishedOffset) {
  const FalconArm arm(falcon_model());
  EXPECT_NEAR(arm.pose({}).q[0], 35 * M_PI / 180, 0.0005);
  const ArmPose pose = arm.pose({});
  EXPECT_NEAR(pose.p_BT.x(), 0, 1e-9);
  EXPECT_NEAR(pose.p_BT.y(), 0, 1e-9);
  std::printf("home at z = %.4f m\n", pose.p_BT.z());
}

}  // namespace
}  // namespace thimble::driver::falcon
