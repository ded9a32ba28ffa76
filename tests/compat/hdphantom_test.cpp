// libhdPhantom as CHAI3D and AMBF use it: the same calls in the same order.
#include <Eigen/LU>
#include <array>
#include <chrono>
#include <cmath>
#include <cstring>
#include <limits>

#include "compat/exec_rig.h"
#include "hdPhantom.h"

namespace thimble::compat {
namespace {

using Eigen::Vector3d;

constexpr double kQuantum = 0.005;  // N

TEST(CompatHdPhantom, ReturnsValuesInTheAxesOfCHAI3D) {
  ExecRig rig;
  EXPECT_EQ(hdPhantomGetNumDevices(), 1);
  double radius = 0;
  EXPECT_EQ(hdPhantomGetWorkspaceRadius(0, &radius), 1);
  EXPECT_EQ(radius, 0.1);
  std::array<char, 255> name;
  name.fill('x');
  EXPECT_EQ(hdPhantomGetType(0, name.data()), 1);
  EXPECT_STREQ(name.data(), "vintage_phantom");
  ASSERT_EQ(hdPhantomOpen(0), 0);
  Vector3d p, v;
  std::array<double, 9> R;
  const Vector3d f(0.1, 0.2, -0.15), none(0, 0, 0);
  for (int i = 0; i < 700; ++i) {
    // Getters return whether they succeeded.
    ASSERT_NE(hdPhantomGetPosition(0, &p.x(), &p.y(), &p.z()), 0);
    hdPhantomGetRotation(0, &R[0], &R[1], &R[2], &R[3], &R[4], &R[5], &R[6], &R[7], &R[8]);
    EXPECT_EQ(hdPhantomGetButtons(0), 0);
    ASSERT_EQ(
        hdPhantomSetForceAndTorque(0, &f.x(), &f.y(), &f.z(), &none.x(), &none.y(), &none.z()), 0);
  }
  EXPECT_LT((rig.motors.force_W() - f).norm(), kQuantum);
  // The hand, of 300 N/m, yields to the force minus friction.
  EXPECT_LT((p - f / 300).norm(), 0.0004) << p.transpose();
  EXPECT_NE(hdPhantomGetLinearVelocity(0, &v.x(), &v.y(), &v.z()), 0);
  EXPECT_LT(v.norm(), 0.05);
  EXPECT_EQ(R, (std::array<double, 9>{1, 0, 0, 0, 1, 0, 0, 0, 1})) << "it has no gimbal";
  hdPhantomStopServo();
  ExecRig::wait(0, 3);
  EXPECT_EQ(rig.motors.force_W().norm(), 0);
  EXPECT_EQ(hdPhantomClose(0), 1);
}

TEST(CompatHdPhantom, SetForceWaitsForATick) {
  ExecRig rig;
  ASSERT_EQ(hdPhantomOpen(0), 0);
  const double zero = 0;
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < 200; ++i) hdPhantomSetForce(0, &zero, &zero, &zero);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  EXPECT_GT(took.count(), 0.19);
}

TEST(CompatHdPhantom, ReturnsTheRotationOfAStylusWithGimbal) {
  ExecRig rig({.arms = {{.arm_file = "polhem"}}});
  ASSERT_EQ(hdPhantomOpen(0), 0);
  ExecRig::wait(0, 400);
  Eigen::Matrix<double, 3, 3, Eigen::RowMajor> R;
  double* r = R.data();
  ASSERT_EQ(hdPhantomGetRotation(0, r, r + 1, r + 2, r + 3, r + 4, r + 5, r + 6, r + 7, r + 8), 1);
  EXPECT_NEAR(R.determinant(), 1, 1e-6);
  EXPECT_LT((R * R.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-6);
  EXPECT_GT((R - Eigen::Matrix3d::Identity()).norm(), 0.01) << "the hand rotates the stylus";
}

TEST(CompatHdPhantom, CountsIgnoredTorques) {
  ExecRig rig;
  ASSERT_EQ(hdPhantomOpen(0), 0);
  const double torque = 0.01, zero = 0;
  for (int i = 0; i < 5; ++i) EXPECT_EQ(hdPhantomSetTorque(0, &torque, &zero, &zero), 0);
  EXPECT_EQ(rig.motors.force_W().norm(), 0);
  EXPECT_EQ(hdPhantomClose(0), 1);
  EXPECT_NE(rig.end().find("Torque    requested 5 times"), std::string::npos);
}

TEST(CompatHdPhantom, ReturnsMinusOneForWrongArguments) {
  ExecRig rig;
  ASSERT_EQ(hdPhantomOpen(0), 0);
  double d = 7;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::array<char, 255> name{};
  for (const int id : {-1, 1, 4, 5, 1'000'000, std::numeric_limits<int>::min()}) {
    EXPECT_EQ(hdPhantomOpen(id), -1);
    EXPECT_EQ(hdPhantomClose(id), -1);
    EXPECT_EQ(hdPhantomGetPosition(id, &d, &d, &d), -1);
    EXPECT_EQ(d, 0) << "outputs must be zero for programs that ignore the return value";
    EXPECT_EQ(hdPhantomGetLinearVelocity(id, &d, &d, &d), -1);
    EXPECT_EQ(hdPhantomGetRotation(id, &d, &d, &d, &d, &d, &d, &d, &d, &d), -1);
    EXPECT_EQ(hdPhantomGetButtons(id), 0);
    EXPECT_EQ(hdPhantomSetForce(id, &d, &d, &d), -1);
    EXPECT_EQ(hdPhantomSetTorque(id, &d, &d, &d), -1);
    EXPECT_EQ(hdPhantomSetForceAndTorque(id, &d, &d, &d, &d, &d, &d), -1);
    EXPECT_EQ(hdPhantomGetWorkspaceRadius(id, &d), -1);
    EXPECT_EQ(hdPhantomGetType(id, name.data()), -1);
  }
  EXPECT_EQ(hdPhantomGetPosition(0, nullptr, &d, &d), -1);
  EXPECT_EQ(hdPhantomGetLinearVelocity(0, &d, nullptr, &d), -1);
  EXPECT_EQ(hdPhantomGetRotation(0, &d, &d, &d, &d, &d, &d, &d, &d, nullptr), -1);
  EXPECT_EQ(hdPhantomSetForce(0, &d, &d, nullptr), -1);
  EXPECT_EQ(hdPhantomSetTorque(0, nullptr, &d, &d), -1);
  EXPECT_EQ(hdPhantomSetForceAndTorque(0, &d, &d, &d, nullptr, &d, &d), -1);
  EXPECT_EQ(hdPhantomGetWorkspaceRadius(0, nullptr), -1);
  EXPECT_EQ(hdPhantomGetType(0, nullptr), -1);
  EXPECT_EQ(hdPhantomSetForce(0, &nan, &d, &d), 0) << "the gate handles it";
  ArmReading reading;
  arms::read(0, reading);
  EXPECT_EQ(reading.fault, driver::Fault::kForceNotFinite);
  hdPhantomStartServo();
  EXPECT_EQ(hdPhantomClose(0), 1);
  EXPECT_EQ(hdPhantomClose(0), -1);
  const std::string report = rig.end();
  EXPECT_NE(report.find("Wrong     hdPhantomGetType 7 times"), std::string::npos) << report;
}

}  // namespace
}  // namespace thimble::compat
