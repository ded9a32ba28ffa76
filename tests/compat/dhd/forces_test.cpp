#include <array>
#include <cmath>
#include <limits>

#include "compat/dhd/dhd_test.h"

namespace thimble::compat {
namespace {

std::array<int, DHD_MAX_STATUS> status(char id = -1) {
  std::array<int, DHD_MAX_STATUS> all{};
  EXPECT_EQ(dhdGetStatus(all.data(), id), 0);
  return all;
}

TEST_F(CompatDhd, FirstForceEnablesForce) {
  begin_and_open({});
  EXPECT_EQ(status()[DHD_STATUS_FORCE], 0);
  EXPECT_EQ(dhdSetForce(1, -2, 0.5), 0);
  EXPECT_LT(fake::f_sent_W(0).norm(), 1) << "the soft start limits the first force";
  send_for_long(1, -2, 0.5);
  EXPECT_EQ(fake::f_sent_W(0), Eigen::Vector3d(1, -2, 0.5));
  EXPECT_EQ(status()[DHD_STATUS_FORCE], 1);
  EXPECT_EQ(status()[DHD_STATUS_FORCE_OFF_CAUSE], 0);
  double force[3], rest[4];
  ASSERT_EQ(dhdGetForceAndTorqueAndGripperForce(&force[0], &force[1], &force[2], &rest[0], &rest[1],
                                                &rest[2], &rest[3]),
            0);
  EXPECT_EQ(force[1], -2);
  EXPECT_EQ(rest[3], 0);
}

TEST_F(CompatDhd, TorqueAndGripperForceAreCountedOnly) {
  begin_and_open({});
  EXPECT_EQ(dhdSetForceAndTorqueAndGripperForce(1, 0, 0, 0.1, 0.2, 0.3, 0.4), 0);
  EXPECT_EQ(fake::asked(0).torque_W[2], 0.3);
  EXPECT_EQ(fake::asked(0).gripper, 0.4);
  EXPECT_EQ(dhdSetForceAndTorque(1, 0, 0, 0.1, 0.2, 0.3), 0);
  EXPECT_EQ(fake::asked(0).gripper, 0);
  EXPECT_EQ(dhdSetForceAndGripperForce(1, 0, 0, 0.4), 0);
  EXPECT_EQ(fake::asked(0).torque_W[2], 0);
  EXPECT_EQ(fake::asked(0).gripper, 0.4);
}

TEST_F(CompatDhd, TorquesOfTheWristsJointsAreCountedOnly) {
  ASSERT_EQ(dhdOpenID(0), 0);
  for (int i = 0; i < 100; ++i) {
    ASSERT_EQ(dhdSetForceAndWristJointTorquesAndGripperForce(1, 2, 3, 0.1, 0.2, 0.3, 4), 0);
  }
  EXPECT_EQ(fake::f_sent_W(0), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(fake::asked(0).torque_W, (std::array<double, 3>{0.1, 0.2, 0.3}));
  EXPECT_EQ(fake::asked(0).gripper, 4);
  ASSERT_EQ(dhdSetForceAndWristJointTorques(3, 2, 1, 0.3, 0, 0), 0);
  EXPECT_EQ(fake::f_sent_W(0), Eigen::Vector3d(3, 2, 1));
  EXPECT_EQ(fake::asked(0).torque_W, (std::array<double, 3>{0.3, 0, 0}));
}

TEST_F(CompatDhd, EachForceWaitsForItsTick) {
  begin_and_open({});
  ArmReading before, after;
  arms::read(0, before);
  for (int i = 0; i < 10; ++i) dhdSetForce(0, 0, 0);
  arms::read(0, after);
  EXPECT_EQ(after.tick - before.tick, 10u);
}

TEST_F(CompatDhd, DisabledForceStaysOffUntilEnabled) {
  for (const auto& off : {+[] { dhdStop(-1); }, +[] { dhdEnableForce(DHD_OFF, -1); }}) {
    begin_and_open({});
    send_for_long(2, 0, 0);
    off();
    EXPECT_EQ(dhdSetForce(2, 0, 0), 0);
    EXPECT_TRUE(fake::f_sent_W(0).isZero(0));
    EXPECT_EQ(status()[DHD_STATUS_IDLE], 1);
    EXPECT_EQ(status()[DHD_STATUS_FORCE_OFF_CAUSE], 4);
    EXPECT_EQ(dhdEnableForce(DHD_ON), 0);
    send_for_long(2, 0, 0);
    EXPECT_EQ(fake::f_sent_W(0), Eigen::Vector3d(2, 0, 0));
  }
}

TEST_F(CompatDhd, EnablingForceDiscardsEarlierForces) {
  begin_and_open({});
  send_for_long(2, 0, 0);
  dhdEnableForce(DHD_OFF);
  dhdEnableForce(DHD_ON);
  fake::pass(0, 0.01);
  EXPECT_TRUE(fake::f_sent_W(0).isZero(0));
}

TEST_F(CompatDhd, ReportsForcesAboveTheLimit) {
  begin_and_open({});
  for (int i = 0; i < 100; ++i) ASSERT_EQ(dhdSetForce(6, 0, 0), DHD_MOTOR_SATURATED);
  EXPECT_NEAR(fake::f_sent_W(0).x(), 5, 1e-9);
  EXPECT_EQ(dhdSetMaxForce(1.5), 0);
  EXPECT_EQ(dhdGetMaxForce(), 1.5);
  EXPECT_EQ(dhdSetForce(2, 0, 0), DHD_MOTOR_SATURATED);
  EXPECT_NEAR(fake::f_sent_W(0).x(), 1.5, 1e-9);
  EXPECT_EQ(dhdSetMaxForce(0), 0);
  dhdSetForce(2, 0, 0);
  EXPECT_LT(fake::f_sent_W(0).norm(), 1e-6) << "a limit of 0 allows no force";
  EXPECT_EQ(dhdSetMaxForce(-1), 0);
  EXPECT_EQ(dhdSetForce(2, 0, 0), 0);
  EXPECT_EQ(dhdGetMaxForce(), -1);
}

TEST_F(CompatDhd, NaNForceLatchesTheGate) {
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    begin_and_open({});
    send_for_long(2, 0, 0);
    EXPECT_EQ(dhdSetForce(0, bad, 0), -1);
    EXPECT_EQ(dhdErrorGetLast(), DHD_ERROR_INVALID);
    EXPECT_EQ(fake::fault(0), driver::Fault::kForceNotFinite);
    dhdSetForce(2, 0, 0);
    EXPECT_TRUE(fake::f_sent_W(0).isZero(0));
    EXPECT_EQ(status()[DHD_STATUS_ERROR], 1);
    EXPECT_EQ(dhdEnableForce(DHD_ON), 0);
    send_for_long(2, 0, 0);
    EXPECT_EQ(fake::f_sent_W(0), Eigen::Vector3d(2, 0, 0));
  }
}

TEST_F(CompatDhd, WatchdogOfTheProgramLatchesUntilForceIsEnabled) {
  begin_and_open({});
  EXPECT_EQ(dhdSetWatchdog(40), -1);
  EXPECT_EQ(dhdErrorGetLast(), DHD_ERROR_EXPERT_MODE_DISABLED);
  dhdEnableExpertMode();
  EXPECT_EQ(dhdSetWatchdog(40), 0);  // 5 ms
  unsigned char steps = 0;
  EXPECT_EQ(dhdGetWatchdog(&steps), 0);
  EXPECT_EQ(steps, 40);
  fake::pass(0, 0.03);
  send_for_long(2, 0, 0);
  EXPECT_EQ(fake::f_sent_W(0), Eigen::Vector3d(2, 0, 0))
      << "the watchdog starts with the first force";
  fake::pass(0, 0.004);
  send_for_long(2, 0, 0);
  EXPECT_EQ(fake::f_sent_W(0), Eigen::Vector3d(2, 0, 0)) << "in time";
  fake::pass(0, 0.01);
  EXPECT_TRUE(fake::f_sent_W(0).isZero(0));
  send_for_long(2, 0, 0);
  EXPECT_TRUE(fake::f_sent_W(0).isZero(0));
  EXPECT_EQ(status()[DHD_STATUS_FORCE_OFF_CAUSE], 3);
  dhdEnableForce(DHD_ON);
  send_for_long(2, 0, 0);
  EXPECT_EQ(fake::f_sent_W(0), Eigen::Vector3d(2, 0, 0));
}

TEST_F(CompatDhd, WithoutItsWatchdogTheForceReturnsAfterAPause) {
  begin_and_open({});
  send_for_long(2, 0, 0);
  fake::pass(0, 0.05);
  EXPECT_TRUE(fake::f_sent_W(0).isZero(0));
  send_for_long(2, 0, 0);
  EXPECT_EQ(fake::f_sent_W(0), Eigen::Vector3d(2, 0, 0));
}

TEST_F(CompatDhd, VelocityThresholdSwitchesTheForceOff) {
  begin_and_open({});
  dhdEnableExpertMode();
  EXPECT_EQ(dhdSetVelocityThreshold(1), 0);
  unsigned speed = 0;
  EXPECT_EQ(dhdGetVelocityThreshold(&speed), 0);
  EXPECT_EQ(speed, 1u);
  fake::change(0, [](ArmReading& now) { now.v_WT = {0, 0.9, 0}; });
  send_for_long(2, 0, 0);
  EXPECT_EQ(fake::f_sent_W(0), Eigen::Vector3d(2, 0, 0));
  fake::change(0, [](ArmReading& now) { now.v_WT = {0, 1.1, 0}; });
  dhdSetForce(2, 0, 0);
  EXPECT_TRUE(fake::f_sent_W(0).isZero(0));
  EXPECT_EQ(status()[DHD_STATUS_FORCE_OFF_CAUSE], 2);
}

TEST_F(CompatDhd, StatusNamesALossAfterAnotherFault) {
  begin_and_open({});
  dhdEnableExpertMode();
  EXPECT_EQ(dhdSetVelocityThreshold(1), 0);
  fake::change(0, [](ArmReading& now) { now.v_WT = {0, 1.1, 0}; });
  dhdSetForce(2, 0, 0);
  EXPECT_EQ(status()[DHD_STATUS_CONNECTED], 1);
  fake::change(0, [](ArmReading& now) { now.link = driver::LinkState::kLost; });
  EXPECT_EQ(status()[DHD_STATUS_CONNECTED], 0);
  EXPECT_EQ(status()[DHD_STATUS_FORCE_OFF_CAUSE], 2) << "the first cause remains";
}

TEST_F(CompatDhd, VibrationIsAddedToTheForce) {
  begin_and_open({});
  EXPECT_EQ(dhdSetVibration(600, 1, 0), -1);
  EXPECT_EQ(dhdErrorGetLast(), DHD_ERROR_INVALID);
  EXPECT_EQ(dhdSetVibration(100, 0.5, 0), 0);
  send_for_long(1, 0, 1);
  double lowest = 9, highest = -9;
  for (int i = 0; i < 100; ++i) {
    dhdSetForce(1, 0, 1);
    EXPECT_EQ(fake::f_sent_W(0).x(), 1);
    lowest = std::min(lowest, fake::f_sent_W(0).z());
    highest = std::max(highest, fake::f_sent_W(0).z());
  }
  EXPECT_NEAR(lowest, 0.5, 0.03);
  EXPECT_NEAR(highest, 1.5, 0.03);
  EXPECT_EQ(dhdSetVibration(0, 0, 0), 0);
  dhdSetForce(1, 0, 1);
  EXPECT_EQ(fake::f_sent_W(0).z(), 1);
}

TEST_F(CompatDhd, TwoArmsGetTheirOwnForces) {
  ASSERT_EQ(dhdOpenID(0), 0);
  ASSERT_EQ(dhdOpenID(1), 1);
  for (int i = 0; i < 100; ++i) {
    dhdSetForce(1, 0, 0, 0);
    dhdSetForce(0, 2, 0, 1);
  }
  EXPECT_EQ(fake::f_sent_W(0), Eigen::Vector3d(1, 0, 0));
  EXPECT_EQ(fake::f_sent_W(1), Eigen::Vector3d(0, 2, 0));
  dhdStop(0);
  dhdSetForce(1, 0, 0, 0);
  dhdSetForce(0, 2, 0, 1);
  EXPECT_TRUE(fake::f_sent_W(0).isZero(0));
  EXPECT_EQ(fake::f_sent_W(1), Eigen::Vector3d(0, 2, 0));
}

TEST_F(CompatDhd, SettingsWithoutEffectAreStored) {
  begin_and_open({});
  EXPECT_EQ(dhdReset(), 0);
  EXPECT_EQ(dhdWaitForReset(100), 0);
  EXPECT_EQ(dhdWaitForReset(-1), -1);
  EXPECT_EQ(dhdSetGravityCompensation(DHD_ON), 0);
  EXPECT_EQ(dhdSetBrakes(DHD_ON), 0);
  EXPECT_EQ(dhdSetEffectorMass(0.2), 0);
  EXPECT_EQ(status()[DHD_STATUS_GRAVITY], 1);
  EXPECT_EQ(status()[DHD_STATUS_BRAKE], 1);
  send_for_long(0, 0, 0);
  EXPECT_TRUE(fake::f_sent_W(0).isZero(0)) << "they cause no force";
  EXPECT_EQ(status()[DHD_STATUS_BRAKE], 0);
  double mass = 0;
  EXPECT_EQ(dhdGetEffectorMass(&mass), 0);
  EXPECT_EQ(mass, 0.2);
  EXPECT_EQ(dhdSetEffectorMass(-0.2), -1);
  EXPECT_EQ(dhdSetDeviceAngleDeg(30), 0);
  double angle = 0;
  EXPECT_EQ(dhdGetDeviceAngleRad(&angle), 0);
  EXPECT_NEAR(angle, 0.5236, 1e-4);
}

}  // namespace
}  // namespace thimble::compat
