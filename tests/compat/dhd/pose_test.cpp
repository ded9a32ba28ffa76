#include <Eigen/Geometry>
#include <array>
#include <numbers>
#include <random>

#include "compat/dhd/dhd_test.h"
#include "support/seed.h"

namespace thimble::compat {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

Eigen::Matrix3d about(double a, double b, double c) {
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  return (AngleAxisd(a, Vector3d::UnitX()) * AngleAxisd(b, Vector3d::UnitY()) *
          AngleAxisd(c, Vector3d::UnitZ()))
      .toRotationMatrix();
}

void turn(int arm, const Eigen::Matrix3d& R) {
  fake::change(arm, [&](ArmReading& now) {
    for (Eigen::Index k = 0; k < 9; ++k) now.R_WT[static_cast<std::size_t>(k)] = R(k / 3, k % 3);
  });
}

TEST_F(CompatDhd, ReturnsPositionAndVelocitiesOfTheTip) {
  begin_and_open({});
  fake::change(0, [](ArmReading& now) {
    now.p_WT = {0.01, 0.02, 0.03}, now.v_WT = {0.1, 0.2, 0.3}, now.w_WT = {1, 2, 3};
  });
  double x = 0, y = 0, z = 0;
  EXPECT_EQ(dhdGetPosition(&x, &y, &z), 0);
  EXPECT_EQ(Eigen::Vector3d(x, y, z), Eigen::Vector3d(0.01, 0.02, 0.03));
  EXPECT_EQ(dhdGetLinearVelocity(&x, &y, &z), 0);
  EXPECT_EQ(Eigen::Vector3d(x, y, z), Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(dhdGetAngularVelocityRad(&x, &y, &z), 0);
  EXPECT_EQ(Eigen::Vector3d(x, y, z), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(dhdGetAngularVelocityDeg(&x, &y, &z), 0);
  EXPECT_NEAR(y, 2 / kDegree, 1e-9);
}

TEST_F(CompatDhd, AnglesAndFrameOfTheStylusAgree) {
  begin_and_open({});
  std::mt19937 random(static_cast<std::uint32_t>(support::seed_of(5)));
  std::uniform_real_distribution<double> turned(-3.1, 3.1), tilted(-1.5, 1.5);
  for (int i = 0; i < 200; ++i) {
    const double a = turned(random), b = i % 10 == 0 ? std::numbers::pi / 2 : tilted(random),
                 c = turned(random);
    const Eigen::Matrix3d R = about(a, b, c);
    turn(0, R);
    double rows[3][3], oa, ob, oc, x, y, z;
    ASSERT_EQ(dhdGetOrientationFrame(rows), 0);
    ASSERT_EQ(dhdGetPositionAndOrientationRad(&x, &y, &z, &oa, &ob, &oc), 0);
    const Eigen::Matrix3d same = about(oa, ob, oc);
    for (int k = 0; k < 9; ++k) {
      ASSERT_NEAR(rows[k / 3][k % 3], R(k / 3, k % 3), 1e-12);
      ASSERT_NEAR(same(k / 3, k % 3), R(k / 3, k % 3), 1e-7);
    }
    double degrees, others[2];
    ASSERT_EQ(dhdGetOrientationDeg(&degrees, &others[0], &others[1]), 0);
    ASSERT_NEAR(degrees, oa / kDegree, 1e-9);
  }
}

TEST_F(CompatDhd, BaseAnglesRotatePositionsAndForces) {
  begin_and_open({});
  turn(0, about(0.3, 0.2, 0.1));
  fake::change(0, [](ArmReading& now) { now.p_WT = {0.01, 0, 0}, now.v_WT = {0, 0.1, 0}; });
  ASSERT_EQ(dhdSetBaseAngleZDeg(90), 0);
  double x, y, z;
  dhdGetPosition(&x, &y, &z);
  EXPECT_TRUE(Eigen::Vector3d(x, y, z).isApprox(Eigen::Vector3d(0, 0.01, 0), 1e-12));
  dhdGetLinearVelocity(&x, &y, &z);
  EXPECT_TRUE(Eigen::Vector3d(x, y, z).isApprox(Eigen::Vector3d(-0.1, 0, 0), 1e-12));
  double rows[3][3];
  dhdGetPositionAndOrientationFrame(&x, &y, &z, rows);
  const Eigen::Matrix3d expected = about(0, 0, 90 * kDegree) * about(0.3, 0.2, 0.1);
  EXPECT_NEAR(rows[0][1], expected(0, 1), 1e-12);
  EXPECT_NEAR(rows[2][0], expected(2, 0), 1e-12);
  send_for_long(0, 2, 0);  // the program's y is the world's x
  EXPECT_TRUE(fake::f_sent_W(0).isApprox(Eigen::Vector3d(2, 0, 0), 1e-9))
      << fake::f_sent_W(0).transpose();
  dhdGetForce(&x, &y, &z);
  EXPECT_NEAR(y, 2, 1e-9);
  ASSERT_EQ(dhdSetBaseAngleXRad(0.5), 0);
  send_for_long(1, 2, 3);
  const Eigen::Matrix3d R_UW = about(0, 0, 90 * kDegree) * about(0.5, 0, 0);
  EXPECT_TRUE(fake::f_sent_W(0).isApprox(R_UW.transpose() * Eigen::Vector3d(1, 2, 3), 1e-9));
  double angle;
  dhdGetBaseAngleXDeg(&angle);
  EXPECT_NEAR(angle, 0.5 / kDegree, 1e-9);
}

TEST_F(CompatDhd, ReturnsOpeningAndSpeedOfTheGripper) {
  begin_and_open({});
  fake::change(0, [](ArmReading& now) { now.gripper = 0.03F, now.p_WT = {0.01, 0, 0}; });
  double gap, angle, thumb[3], finger[3], speed;
  EXPECT_EQ(dhdGetGripperGap(&gap), 0);
  EXPECT_NEAR(gap, 0.03, 1e-8);
  EXPECT_EQ(dhdGetGripperAngleRad(&angle), 0);
  EXPECT_NEAR(angle, 0.5, 1e-6);
  EXPECT_EQ(dhdGetGripperThumbPos(&thumb[0], &thumb[1], &thumb[2]), 0);
  EXPECT_EQ(dhdGetGripperFingerPos(&finger[0], &finger[1], &finger[2]), 0);
  EXPECT_NEAR(finger[1] - thumb[1], 0.03, 1e-8);
  EXPECT_NEAR(finger[0], 0.01, 1e-12);
  fake::pass(0, 0.0009);
  EXPECT_EQ(dhdGetGripperLinearVelocity(&speed), 0);
  EXPECT_EQ(speed, 0);
  fake::pass(0, 0.0095);
  fake::change(0, [](ArmReading& now) { now.gripper = 0.02F; });
  EXPECT_EQ(dhdGetGripperLinearVelocity(&speed), 0);
  EXPECT_NEAR(speed, -1, 0.02);
  EXPECT_EQ(dhdGetGripperAngularVelocityRad(&speed), 0);
  EXPECT_NEAR(speed, -1 / 0.06, 0.5);
  begin_and_open({.has_gripper = false});
  EXPECT_FALSE(dhdHasGripper());
  EXPECT_EQ(dhdGetGripperGap(&gap), -1);
  EXPECT_EQ(dhdErrorGetLast(), DHD_ERROR_NOT_AVAILABLE);
}

TEST_F(CompatDhd, WithoutAGripperOnlySwitchingTheButtonOffSucceeds) {
  begin_and_open({.has_gripper = false});
  EXPECT_EQ(dhdEmulateButton(DHD_OFF), 0);
  EXPECT_EQ(dhdEmulateButton(DHD_ON), -1);
  EXPECT_EQ(dhdErrorGetLast(), DHD_ERROR_NOT_AVAILABLE);
  double gap = 7;
  EXPECT_EQ(dhdGetGripperGap(&gap), -1);
  EXPECT_EQ(dhdErrorGetLast(), DHD_ERROR_NOT_AVAILABLE);
  EXPECT_EQ(gap, 7);
}

TEST_F(CompatDhd, ReturnsTheJacobianAtAnyJointAngles) {
  begin_and_open({});
  dhdSetBaseAngleZDeg(90);
  double now[3][3], same[3][3], other[3][3];
  ASSERT_EQ(dhdGetDeltaJacobian(now), 0);
  ASSERT_EQ(dhdDeltaJointAnglesToJacobian(0, 0, 0, same), 0);
  ASSERT_EQ(dhdDeltaJointAnglesToJacobian(0.5, 0.1, 0, other), 0);
  for (int i = 0; i < 9; ++i) {
    EXPECT_EQ(same[i / 3][i % 3], now[i / 3][i % 3]);
    EXPECT_NEAR(other[i / 3][i % 3], 1.5 * now[i / 3][i % 3], 1e-12);
  }
  EXPECT_EQ(dhdDeltaJointAnglesToJacobian(3, 0, 0, other), -1);
  EXPECT_EQ(dhdErrorGetLast(), DHD_ERROR_GEOMETRY);
  EXPECT_EQ(dhdWristJointAnglesToJacobian(0, 0, 0, other), -1);
  EXPECT_EQ(dhdErrorGetLast(), DHD_ERROR_NOT_AVAILABLE);
}

TEST_F(CompatDhd, ReturnsTheJointsOfBaseAndWrist) {
  begin_and_open({});
  fake::change(0, [](ArmReading& now) {
    now.q = {0.1, 0.2, 0.3}, now.gimbal = {1, 2, 3}, now.counts = {10, -20, 30};
  });
  double q[3], wrist[3];
  int counts[3];
  ASSERT_EQ(dhdGetDeltaJointAngles(&q[0], &q[1], &q[2]), 0);
  ASSERT_EQ(dhdGetWristJointAngles(&wrist[0], &wrist[1], &wrist[2]), 0);
  ASSERT_EQ(dhdGetDeltaEncoders(&counts[0], &counts[1], &counts[2]), 0);
  EXPECT_EQ(q[2], 0.3);
  EXPECT_EQ(wrist[1], 2);
  EXPECT_EQ(counts[1], -20);
  begin_and_open({.has_orientation = false});
  EXPECT_EQ(dhdGetWristJointAngles(&wrist[0], &wrist[1], &wrist[2]), -1);
  EXPECT_EQ(dhdErrorGetLast(), DHD_ERROR_NOT_AVAILABLE);
}

TEST_F(CompatDhd, ReturnsButtonsAndTheEmulatedButton) {
  begin_and_open({});
  fake::change(0, [](ArmReading& now) { now.buttons = 0b1010, now.gripper = 0.03F; });
  EXPECT_EQ(dhdGetButton(0), 0);
  EXPECT_EQ(dhdGetButton(1), 1);
  EXPECT_EQ(dhdGetButtonMask(), 0b1010u);
  EXPECT_EQ(dhdGetButton(16), -1);
  EXPECT_EQ(dhdErrorGetLast(), DHD_ERROR_INVALID_INDEX);
  EXPECT_EQ(dhdGetButton(-1), -1);
  EXPECT_EQ(dhdEmulateButton(DHD_ON), 0);
  EXPECT_EQ(dhdGetButton(0), 0);
  fake::change(0, [](ArmReading& now) { now.gripper = 0.001F; });
  EXPECT_EQ(dhdGetButton(0), 1);
  EXPECT_EQ(dhdEmulateButton(DHD_OFF), 0);
  EXPECT_EQ(dhdGetButton(0), 0);
}

TEST_F(CompatDhd, ReturnsJointsAndConvertsTorquesToTipForce) {
  begin_and_open({});
  fake::change(0, [](ArmReading& now) {
    now.q = {0.1, 0.2, 0.3}, now.gimbal = {1, 2, 3}, now.counts = {10, -20, 30},
    now.v_WT = {0.01, 0.02, 0.03};
  });
  double angles[DHD_MAX_DOF], speeds[DHD_MAX_DOF], rows[3][3];
  ASSERT_EQ(dhdGetJointAngles(angles), 0);
  EXPECT_EQ(angles[1], 0.2);
  EXPECT_EQ(angles[5], 3);
  EXPECT_EQ(angles[7], 0);
  ASSERT_EQ(dhdGetDeltaJacobian(rows), 0);
  EXPECT_EQ(rows[1][2], fake::jacobian()(1, 2));
  ASSERT_EQ(dhdGetJointVelocities(speeds), 0);
  const Eigen::Vector3d v = fake::jacobian() * Eigen::Vector3d(speeds[0], speeds[1], speeds[2]);
  EXPECT_TRUE(v.isApprox(Eigen::Vector3d(0.01, 0.02, 0.03), 1e-9));
  int counts[DHD_MAX_DOF] = {7, 7, 7, 7, 7, 7, 7, 7};
  ASSERT_EQ(dhdGetEnc(counts, 0b1011), 0);
  EXPECT_EQ(counts[0], 10);
  EXPECT_EQ(counts[2], 7) << "values outside the mask must not change";
  EXPECT_EQ(counts[3], 0);

  const Eigen::Vector3d f_W(0.5, -1, 1.5);
  const Eigen::Vector3d tau = fake::jacobian().transpose() * f_W;
  double torques[DHD_MAX_DOF] = {tau[0], tau[1], tau[2], 9, 9, 9, 9, 9};
  EXPECT_EQ(dhdSetJointTorques(torques), -1);
  EXPECT_EQ(dhdErrorGetLast(), DHD_ERROR_EXPERT_MODE_DISABLED);
  dhdEnableExpertMode();
  for (int i = 0; i < 100; ++i) ASSERT_EQ(dhdSetJointTorques(torques), 0);
  EXPECT_TRUE(fake::f_sent_W(0).isApprox(f_W, 1e-9));

  double gravity[DHD_MAX_DOF], inertia[6][6];
  EXPECT_EQ(dhdJointAnglesToInertiaMatrix(angles, inertia), -1) << "no mass was set";
  dhdSetEffectorMass(0.2);
  ASSERT_EQ(dhdJointAnglesToGravityJointTorques(angles, gravity), 0);
  EXPECT_NEAR(gravity[2], fake::jacobian()(2, 2) * 0.2 * 9.80665, 1e-12);
  double raised[DHD_MAX_DOF] = {1, 0, 0, 0, 0, 0, 0, 0};
  ASSERT_EQ(dhdJointAnglesToGravityJointTorques(raised, gravity), 0);
  EXPECT_NEAR(gravity[2], 2 * fake::jacobian()(2, 2) * 0.2 * 9.80665, 1e-12);
  ASSERT_EQ(dhdJointAnglesToInertiaMatrix(angles, inertia), 0);
  EXPECT_EQ(inertia[1][1], 0.2);
  EXPECT_EQ(inertia[4][4], 0);
  angles[0] = 2;  // the arm cannot have it
  EXPECT_EQ(dhdJointAnglesToGravityJointTorques(angles, gravity), -1);
}

TEST_F(CompatDhd, TorquesAtASingularityMakeNoForce) {
  begin_and_open({});
  dhdEnableExpertMode();
  fake::change(0, [](ArmReading& now) { now.J_WT = {0.1, 0.1, 0, 0, 0, 0.1, 0, 0, 0}; });
  double torques[DHD_MAX_DOF] = {1, 1, 1, 0, 0, 0, 0, 0};
  EXPECT_EQ(dhdSetJointTorques(torques), -1);
  EXPECT_EQ(dhdErrorGetLast(), DHD_ERROR_GEOMETRY);
  EXPECT_TRUE(fake::f_sent_W(0).isZero(0));
}

}  // namespace
}  // namespace thimble::compat
