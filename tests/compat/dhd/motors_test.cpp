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
  ExecRig::wait(0, 800);
  double x, y, z;
  ASSERT_EQ(dhdGetPosition(&x, &y, &z), 0);
  // Its spring of 400 N/m against the hand's of 300.
  EXPECT_NEAR(x, 0.006 * 400 / 700, 0.0006);
  EXPECT_NEAR(rig.motors.force_W().x(), 400 * (0.006 - x), 0.1);
  EXPECT_EQ(drdStop(false), 0);
  ExecRig::wait(0, 5);
  EXPECT_EQ(rig.motors.force_W().norm(), 0);
  EXPECT_EQ(drdClose(), 0);
}

}  // namespace
}  // namespace thimble::compat
