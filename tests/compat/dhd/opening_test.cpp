#include <array>
#include <string>

#include "compat/dhd/dhd_test.h"

namespace thimble::compat {
namespace {

TEST_F(CompatDhd, OpensArmsByNumberTypeAndSerial) {
  EXPECT_EQ(dhdGetDeviceCount(), 2);
  EXPECT_EQ(dhdGetDeviceID(), -1);
  EXPECT_EQ(dhdOpen(), 0);
  EXPECT_EQ(dhdOpen(), 1);
  EXPECT_EQ(dhdGetDeviceID(), 1);
  EXPECT_EQ(dhdClose(1), 0);
  EXPECT_EQ(dhdOpenType(DHD_DEVICE_FALCON), 1);
  EXPECT_EQ(dhdClose(1), 0);
  EXPECT_EQ(dhdOpenSerial(2), 1);
  unsigned short serial = 0;
  EXPECT_EQ(dhdGetSerialNumber(&serial, 1), 0);
  EXPECT_EQ(serial, 2);
  EXPECT_EQ(dhdOpenID(1), 1) << "opening an open arm returns its number";
  EXPECT_EQ(drdOpenID(0), 0);
  EXPECT_EQ(drdGetDeviceID(), 0);
}

TEST_F(CompatDhd, ReportsWhyNoArmIsOpened) {
  EXPECT_EQ(dhdOpenID(2), -1);
  EXPECT_EQ(dhdErrorGetLast(), DHD_ERROR_INVALID_INDEX);
  EXPECT_EQ(dhdOpenID(-1), -1);
  EXPECT_EQ(dhdErrorGetLast(), DHD_ERROR_INVALID_INDEX);
  EXPECT_EQ(dhdOpenType(DHD_DEVICE_SIGMA331), -1);
  EXPECT_EQ(dhdErrorGetLast(), DHD_ERROR_NO_DEVICE_FOUND);
  EXPECT_EQ(dhdOpenSerial(0), -1);
  begin({.arms = 0});
  EXPECT_EQ(dhdOpen(), -1);
  EXPECT_EQ(dhdErrorGetLast(), DHD_ERROR_NO_DEVICE_FOUND);
  EXPECT_NE(std::string(dhdErrorGetLastStr()).find("thimble exec"), std::string::npos);
}

TEST_F(CompatDhd, ArmOfAnotherProgramIsNotAvailable) {
  begin({.taken = 0});
  EXPECT_EQ(dhdGetDeviceCount(), 2);
  EXPECT_EQ(dhdGetAvailableCount(), 1);
  EXPECT_EQ(dhdOpenID(0), -1);
  EXPECT_EQ(dhdErrorGetLast(), DHD_ERROR_DEVICE_NOT_READY);
  EXPECT_EQ(dhdGetDeviceID(), -1);
  EXPECT_EQ(dhdOpen(), 1) << "the first arm that no other program has";
  EXPECT_EQ(dhdOpenID(0), -1);
  EXPECT_EQ(dhdGetDeviceID(), 1) << "a refused opening does not change the default arm";
}

TEST_F(CompatDhd, MinusOneIsTheLastChosenArm) {
  ASSERT_EQ(dhdOpenID(0), 0);
  ASSERT_EQ(dhdOpenID(1), 1);
  fake::change(0, [](ArmReading& now) { now.p_WT = {0.01, 0, 0}; });
  fake::change(1, [](ArmReading& now) { now.p_WT = {0.02, 0, 0}; });
  double x = 0, y = 0, z = 0;
  EXPECT_EQ(dhdGetPosition(&x, &y, &z), 0);
  EXPECT_EQ(x, 0.02);
  EXPECT_EQ(dhdSetDevice(0), 0);
  EXPECT_EQ(dhdGetPosition(&x, &y, &z), 0);
  EXPECT_EQ(x, 0.01);
  EXPECT_EQ(dhdGetPosition(&x, &y, &z, 1), 0);
  EXPECT_EQ(x, 0.02);
  EXPECT_EQ(dhdClose(0), 0);
  EXPECT_EQ(dhdGetDeviceID(), -1);
  EXPECT_EQ(dhdGetPosition(&x, &y, &z), -1) << "no arm is chosen after the chosen one was closed";
  EXPECT_EQ(dhdGetPosition(&x, &y, &z, 1), 0);
}

TEST_F(CompatDhd, TypeFollowsNameOrEnvironment) {
  dhdOpenID(0);
  dhdOpenID(1);
  EXPECT_EQ(dhdGetSystemType(0), DHD_DEVICE_CUSTOM);
  EXPECT_EQ(dhdGetSystemType(1), DHD_DEVICE_FALCON);
  EXPECT_STREQ(dhdGetSystemName(0), "vintage_phantom");
  setenv("THIMBLE_DHD_TYPE", "33", 1);
  EXPECT_EQ(dhdGetSystemType(0), DHD_DEVICE_OMEGA3);
  setenv("THIMBLE_DHD_TYPE", "sigma", 1);
  EXPECT_EQ(dhdGetSystemType(0), DHD_DEVICE_CUSTOM);
  unsetenv("THIMBLE_DHD_TYPE");
}

TEST_F(CompatDhd, ClosingResetsTheSettingsOfAnArm) {
  dhdOpenID(0);
  dhdSetBaseAngleZDeg(30);
  dhdSetMaxForce(1);
  dhdSetEffectorMass(0.3);
  dhdStop();
  dhdClose();
  dhdOpenID(0);
  double angle = 1, mass = 1;
  dhdGetBaseAngleZRad(&angle);
  dhdGetEffectorMass(&mass);
  EXPECT_EQ(angle, 0);
  EXPECT_EQ(mass, 0);
  EXPECT_EQ(dhdGetMaxForce(), -1);
  send_for_long(1, 0, 0);
  EXPECT_NEAR(fake::f_sent_W(0).x(), 1, 1e-9) << "closing must reset a disabled force";
}

TEST_F(CompatDhd, EachErrorHasItsText) {
  for (int error = 0; error <= DHD_ERROR_NO_REGULATION; ++error) {
    EXPECT_GT(std::string(dhdErrorGetStr(error)).size(), 5u);
    for (int other = 0; other < error; ++other)
      EXPECT_STRNE(dhdErrorGetStr(error), dhdErrorGetStr(other));
  }
  EXPECT_STREQ(dhdErrorGetStr(-1), dhdErrorGetStr(23));
}

TEST_F(CompatDhd, ReportsTheEndOfTheRun) {
  dhdOpenID(0);
  fake::end_run();
  double x = 7, y = 7, z = 7;
  EXPECT_EQ(dhdGetPosition(&x, &y, &z), -1);
  EXPECT_EQ(x, 7) << "a failed call must not change its outputs";
  EXPECT_EQ(dhdErrorGetLast(), DHD_ERROR_COM);
  EXPECT_EQ(dhdSetForce(1, 0, 0), -1);
  EXPECT_EQ(dhdErrorGetLast(), DHD_ERROR_COM);
}

}  // namespace
}  // namespace thimble::compat
