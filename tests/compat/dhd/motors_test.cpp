// The motors of a simulated arm exert the force that a program requests by dhdSetForce and others.
#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "compat/exec_rig.h"
#include "drdc.h"

namespace thimble::compat {
namespace {

using Eigen::Vector3d;

constexpr double kQuantum = 0.005;  // N, of a motor value

TEST(CompatDhdMotors, ExertTheRequestedForce) {
  for (const char* arm : {"vintage_phantom", "woodenhaptics"}) {
    ExecRig rig(in_step(arm));
    ASSERT_EQ(dhdOpenID(0), 0) << dhdErrorGetLastStr();
    for (const Vector3d& f : {Vector3d(0.5, -0.3, 0.2), Vector3d(0, 0, -0.4), Vector3d(0, 0, 0)}) {
      for (int i = 0; i < 500; ++i) ASSERT_EQ(dhdSetForce(f.x(), f.y(), f.z(), -1), 0);
      EXPECT_LT((rig.motors.force_W() - f).norm(), kQuantum)
          << arm << ", asked for " << f.transpose();
    }
    EXPECT_EQ(dhdClose(-1), 0);
  }
}

TEST(CompatDhdMotors, ExertTheForceInTheProgramsFrame) {
  ExecRig rig(in_step());
  ASSERT_EQ(dhdOpenID(0), 0);
  ASSERT_EQ(dhdSetBaseAngleZDeg(90), 0);
  for (int i = 0; i < 500; ++i) ASSERT_EQ(dhdSetForce(0, 0.5, 0.1, -1), 0);
  EXPECT_LT((rig.motors.force_W() - Vector3d(0.5, 0, 0.1)).norm(), kQuantum);
  double x, y, z;
  ASSERT_EQ(dhdGetPosition(&x, &y, &z), 0);
  EXPECT_NEAR(y, 0.5 / 300, 0.0006) << "the hand gives way where the program pushes";
  EXPECT_EQ(dhdClose(-1), 0);
}

TEST(CompatDhdMotors, ExertTheForceOfJointTorques) {
  ExecRig rig(in_step());
  ASSERT_EQ(dhdOpenID(0), 0);
  dhdEnableExpertMode();
  const Vector3d f(0.3, 0.2, -0.1);
  for (int i = 0; i < 500; ++i) {
    double rows[3][3], torques[DHD_MAX_DOF] = {};
    ASSERT_EQ(dhdGetDeltaJacobian(rows), 0);
    for (int j = 0; j < 3; ++j)
      torques[j] = rows[0][j] * f.x() + rows[1][j] * f.y() + rows[2][j] * f.z();
    ASSERT_EQ(dhdSetJointTorques(torques), 0);
  }
  EXPECT_LT((rig.motors.force_W() - f).norm(), kQuantum);
  dhdDisableExpertMode();
  EXPECT_EQ(dhdClose(-1), 0);
}

TEST(CompatDhdMotors, JacobianAtOtherAnglesIsThatOfTheArm) {
  for (const char* arm : {"vintage_phantom", "polhem", "falcon"}) {
    ExecRig rig(in_step(arm));
    ASSERT_EQ(drdOpenID(0), 0);
    double before[3][3], after[3][3], again[3][3], q[3];
    ASSERT_EQ(dhdGetDeltaJointAngles(&q[0], &q[1], &q[2]), 0);
    ASSERT_EQ(dhdGetDeltaJacobian(before), 0);
    ASSERT_EQ(drdStart(), 0);
    ASSERT_EQ(drdMoveToPos(0.02, -0.01, 0.015, true), 0);
    ASSERT_EQ(drdStop(true), 0);
    ASSERT_EQ(dhdGetDeltaJacobian(after), 0);
    ASSERT_EQ(dhdDeltaJointAnglesToJacobian(q[0], q[1], q[2], again), 0);
    double moved = 0;
    for (int i = 0; i < 9; ++i) {
      EXPECT_NEAR(again[i / 3][i % 3], before[i / 3][i % 3], 1e-9) << arm;
      moved = std::max(moved, std::abs(after[i / 3][i % 3] - before[i / 3][i % 3]));
    }
    EXPECT_GT(moved, 1e-3) << arm << ": the arm has another pose";
    EXPECT_EQ(dhdDeltaJointAnglesToJacobian(std::nan(""), 0, 0, again), -1);
    EXPECT_EQ(dhdErrorGetLast(), DHD_ERROR_GEOMETRY);
    EXPECT_EQ(dhdClose(-1), 0);
  }
}

TEST(CompatDhdMotors, ExertNoForceWhenDisabledOrClosed) {
  ExecRig rig(in_step());
  ASSERT_EQ(dhdOpenID(0), 0);
  for (int i = 0; i < 500; ++i) dhdSetForce(0.5, 0, 0, -1);
  EXPECT_GT(rig.motors.force_W().norm(), 0.4);
  ASSERT_EQ(dhdStop(), 0);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(dhdSetForce(0.5, 0, 0, -1), 0);
  EXPECT_EQ(rig.motors.force_W().norm(), 0);
  EXPECT_EQ(dhdClose(-1), 0);
}

TEST(CompatDhdMotors, NaNForceStopsMotorsUntilForceIsEnabled) {
  ExecRig rig(in_step());
  ASSERT_EQ(dhdOpenID(0), 0);
  for (int i = 0; i < 500; ++i) dhdSetForce(0.5, 0, 0, -1);
  EXPECT_EQ(dhdSetForce(std::nan(""), 0, 0, -1), -1);
  for (int i = 0; i < 20; ++i) dhdSetForce(0.5, 0, 0, -1);
  EXPECT_EQ(rig.motors.force_W().norm(), 0);
  int status[DHD_MAX_STATUS];
  ASSERT_EQ(dhdGetStatus(status), 0) << dhdErrorGetLastStr();
  EXPECT_EQ(status[DHD_STATUS_ERROR], 1);
  EXPECT_EQ(dhdEnableForce(DHD_ON), 0);
  for (int i = 0; i < 700; ++i) dhdSetForce(0.5, 0, 0, -1);
  EXPECT_NEAR(rig.motors.force_W().x(), 0.5, kQuantum);
  EXPECT_EQ(dhdClose(-1), 0);
}

TEST(CompatDhdMotors, HoldTheTipDuringRegulation) {
  ExecRig rig;
  ASSERT_EQ(drdOpenID(0), 0);
  ASSERT_EQ(drdStart(), 0);
  ExecRig::wait(0, 400);
  ASSERT_EQ(drdMoveToPos(0.006, 0, 0, false), 0);
  ExecRig::wait(0, 1500);
  double x, y, z;
  ASSERT_EQ(dhdGetPosition(&x, &y, &z), 0);
  EXPECT_NEAR(x, 0.006, 0.001) << "the hand yields";
  EXPECT_EQ(drdStop(false), 0);
  ExecRig::wait(0, 5);
  EXPECT_EQ(rig.motors.force_W().norm(), 0);
  EXPECT_EQ(drdClose(), 0);
}

TEST(CompatDhdMotors, MoveTheTipToAPoint) {
  for (const char* arm : {"vintage_phantom", "falcon", "polhem", "woodenhaptics"}) {
    ExecRig rig(in_step(arm));
    ASSERT_EQ(drdOpenID(0), 0);
    ASSERT_EQ(drdStart(), 0);
    const Vector3d goal(0.02, -0.01, 0.015);
    EXPECT_EQ(drdMoveToPos(goal.x(), goal.y(), goal.z(), true), 0)
        << arm << ": " << dhdErrorGetLastStr();
    Vector3d p;
    ASSERT_EQ(dhdGetPosition(&p.x(), &p.y(), &p.z()), 0);
    EXPECT_LT((p - goal).norm(), 0.002) << arm << ": " << p.transpose();
    EXPECT_FALSE(drdIsMoving());
    EXPECT_EQ(drdClose(), 0);
  }
}

TEST(CompatDhdMotors, FailToMoveWithoutForce) {
  ExecRig rig(in_step());
  ASSERT_EQ(drdOpenID(0), 0);
  ASSERT_EQ(drdSetMotRatioMax(0.0), 0);
  ASSERT_EQ(drdStart(), 0);
  EXPECT_EQ(drdMoveToPos(0.02, 0, 0, true), -1);
  EXPECT_EQ(dhdErrorGetLast(), DHD_ERROR_TIMEOUT);
  EXPECT_FALSE(drdIsMoving());
  EXPECT_EQ(drdClose(), 0);
}

TEST(CompatDhdMotors, InitializationTurnsTheEncoders) {
  ExecOptions options = in_step();
  options.hand = THIMBLE_SOURCE_DIR "/tests/compat/fast_hand.txt";
  ExecRig rig(options);
  ASSERT_EQ(drdOpenID(0), 0);
  for (int i = 0; i < 250; ++i) dhdSetForce(0, 0, 0, -1);
  int before[3], after[3];
  Vector3d p;
  ASSERT_EQ(dhdGetPosition(&p.x(), &p.y(), &p.z()), 0);
  ASSERT_GT(p.norm(), 0.005);
  ASSERT_EQ(dhdGetDeltaEncoders(&before[0], &before[1], &before[2]), 0);
  ASSERT_EQ(drdAutoInit(), 0);
  ASSERT_EQ(dhdGetDeltaEncoders(&after[0], &after[1], &after[2]), 0);
  ASSERT_EQ(dhdGetPosition(&p.x(), &p.y(), &p.z()), 0);
  EXPECT_LT(p.norm(), 0.002) << p.transpose();
  EXPECT_GT(std::abs(after[0] - before[0]) + std::abs(after[1] - before[1]), 20);
  EXPECT_EQ(drdClose(), 0);
}

TEST(CompatDhdMotors, MoveAFreeHandWithoutRegulation) {
  ExecOptions options = in_step();
  options.hand = "free";
  ExecRig rig(options);
  ASSERT_EQ(dhdOpenID(0), 0);
  double x, y, z;
  for (int i = 0; i < 1500; ++i) ASSERT_EQ(dhdSetForce(0.5, 0, 0, -1), 0);
  ASSERT_EQ(dhdGetPosition(&x, &y, &z), 0);
  EXPECT_GT(x, 0.01) << "a hand at its place yields 1.7 mm";
  EXPECT_EQ(dhdClose(-1), 0);
}

}  // namespace
}  // namespace thimble::compat
