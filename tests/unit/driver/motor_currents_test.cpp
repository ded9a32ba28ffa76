#include "thimble/driver/motor_currents.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "support/random.h"
#include "support/vintage_arm.h"

namespace thimble::driver {
namespace {

GatedForce gated(const Eigen::Vector3d& f_T_W) {
  SafetyGate gate({.force_max = 1e9,
                   .speed_max = 1,
                   .rise_max = 1e18,
                   .soft_start = 1e-9,
                   .stall_ns = 1'000'000'000,
                   .watchdog_ns = 2'000'000'000});
  return gate.pass(f_T_W, Eigen::Vector3d::Zero(), 0.5);
}

Eigen::Vector3d force_of(const MotorCurrents& currents, const Eigen::Matrix3d& J_BT,
                         const std::array<MotorDrive, 3>& drives) {
  Eigen::Vector3d tau;
  for (int i = 0; i < 3; ++i) {
    const auto& drive = drives[static_cast<std::size_t>(i)];
    tau[i] = drive.sign * drive.ratio * drive.torque_constant * currents.amperes()[i];
  }
  return J_BT.transpose().inverse() * tau;
}

TEST(MotorCurrents, ExertTheRequestedTipForce) {
  const auto model = support::vintage_model();
  support::Random random(31);
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3d q = support::vintage_home() + random.in_box(0.4);
    const Eigen::Matrix3d J_BT = model.geometry.jacobian(q);
    const Eigen::Vector3d f = random.in_box(1);
    const MotorCurrents currents(gated(f), Eigen::Matrix3d::Identity(), J_BT, model.drives);
    EXPECT_EQ(currents.scale(), 1);
    EXPECT_LT((force_of(currents, J_BT, model.drives) - f).norm(), 1e-12);
  }
}

TEST(MotorCurrents, KeepTheDirectionOfAForceBeyondTheMotors) {
  const auto model = support::vintage_model();
  support::Random random(32);
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3d q = support::vintage_home() + random.in_box(0.4);
    const Eigen::Matrix3d J_BT = model.geometry.jacobian(q);
    const Eigen::Vector3d f = 50 * random.direction();
    const MotorCurrents currents(gated(f), Eigen::Matrix3d::Identity(), J_BT, model.drives);
    EXPECT_LT(currents.scale(), 1);
    EXPECT_NEAR(currents.amperes().cwiseAbs().maxCoeff(), 3.0, 1e-12);
    EXPECT_LT((force_of(currents, J_BT, model.drives) - currents.scale() * f).norm(), 1e-10);
  }
}

TEST(MotorCurrents, TurnTheWorldsForceIntoTheBase) {
  const auto model = support::vintage_model();
  const Eigen::Matrix3d J_BT = model.geometry.jacobian(support::vintage_home());
  Eigen::Matrix3d R_WB;  // the x axis of the base is the world's y axis
  R_WB << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  const MotorCurrents currents(gated({0, 1, 0}), R_WB, J_BT, model.drives);
  EXPECT_LT((force_of(currents, J_BT, model.drives) - Eigen::Vector3d(1, 0, 0)).norm(), 1e-12);
}

TEST(MotorCurrents, AreZeroWhenTheJacobianIsNotFinite) {
  const auto model = support::vintage_model();
  Eigen::Matrix3d J_BT = model.geometry.jacobian(support::vintage_home());
  J_BT(1, 1) = NAN;
  const MotorCurrents currents(gated({1, 1, 1}), Eigen::Matrix3d::Identity(), J_BT, model.drives);
  EXPECT_EQ(currents.amperes(), Eigen::Vector3d(0, 0, 0));
  EXPECT_EQ(currents.scale(), 0);
}

}  // namespace
}  // namespace thimble::driver
