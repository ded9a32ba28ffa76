// HDAPI in this process: units, axes, frames, errors and limits.
#include <HD/hd.h>

#include <array>
#include <cmath>
#include <map>

#include "compat/exec_rig.h"
#include "compat/hd_frames.h"

namespace thimble::compat {
namespace {

using Eigen::Vector3d;

constexpr double kQuantum = 0.005;  // N

using CompatHd = HdTest;

TEST_F(CompatHd, MotorsGetTheForceInHdapiAxes) {
  ExecRig rig;
  EXPECT_EQ(hdGetCurrentDevice(), 0u) << "ctypes clients call it before they open an arm";
  ASSERT_EQ(hdInitDevice(HD_DEFAULT_DEVICE), 0u);
  hdEnable(HD_FORCE_OUTPUT);
  const std::array<double, 3> f{0.2, 0.1, -0.15};  // right, up, to the user
  hd_frames(0, 400, [&] { hdSetDoublev(HD_CURRENT_FORCE, f.data()); });
  // Our world: x to the user, y right, z up.
  EXPECT_LT((rig.motors.force_W() - Vector3d(f[2], f[0], f[1])).norm(), kQuantum)
      << rig.motors.force_W().transpose();
  std::array<double, 3> asked{}, sent{}, p{};
  std::array<double, 16> T{};
  hdGetDoublev(HD_CURRENT_FORCE, asked.data());
  hdGetDoublev(HD_LAST_FORCE, sent.data());
  hdGetDoublev(HD_CURRENT_POSITION, p.data());
  hdGetDoublev(HD_CURRENT_TRANSFORM, T.data());
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(asked[i], f[i]);
    EXPECT_NEAR(sent[i], f[i], kQuantum);
    EXPECT_NEAR(p[i], 1e3 * f[i] / 300, 0.4) << "mm; the hand of 300 N/m yields";
    EXPECT_NEAR(T[12 + i], p[i], 0.1);
    EXPECT_EQ(T[5 * i], 1);
  }
  EXPECT_EQ(T[15], 1);
  EXPECT_EQ(hdGetError().errorCode, HD_SUCCESS);
}

TEST_F(CompatHd, FindsArmsByCommonNames) {
  ExecRig rig({.arms = {{.arm_file = "vintage_phantom"}, {.arm_file = "falcon"}}});
  const std::map<const char*, HHD> names{
      {nullptr, 0},       {"", 0},         {"Default Device", 0},  {"DEFAULT DEVICE", 0},
      {"PHANToM 1", 0},   {"Phantom1", 0}, {"Default PHANToM", 0}, {"vintage_phantom", 0},
      {"Left Device", 0}, {"falcon", 1},   {"Phantom2", 1},        {"PHANToM 2", 1},
      {"Right Device", 1}};
  for (const auto& [name, handle] : names) {
    ASSERT_EQ(hdInitDevice(name), handle) << (name ? name : "NULL");
    EXPECT_EQ(hdGetCurrentDevice(), handle);
    EXPECT_EQ(hdGetError().errorCode, HD_SUCCESS);
    hdDisableDevice(handle);
  }
  for (const char* name : {"Phantom3", "PHANToM 0", "omega", "Phantom99999999999", "phantom x"}) {
    EXPECT_EQ(hdInitDevice(name), HD_INVALID_HANDLE) << name;
    const HDErrorInfo error = hdGetError();
    EXPECT_EQ(error.errorCode, HD_COMM_CONFIG_ERROR);
  }
}

TEST_F(CompatHd, ReportsAnArmThatIsAlreadyOpen) {
  ExecRig rig;
  ASSERT_EQ(hdInitDevice(nullptr), 0u);
  EXPECT_EQ(hdInitDevice("PHANToM 1"), HD_INVALID_HANDLE);
  EXPECT_EQ(hdGetError().errorCode, HD_DEVICE_ALREADY_INITIATED);
  hdDisableDevice(0);
  EXPECT_EQ(hdInitDevice("PHANToM 1"), 0u);
}

TEST_F(CompatHd, RequiresCalibrationOnlyOnce) {
  ExecRig rig;
  hdInitDevice(nullptr);
  EXPECT_EQ(hdCheckCalibration(), HD_CALIBRATION_NEEDS_UPDATE);
  HDint style = 0;
  hdGetIntegerv(HD_CALIBRATION_STYLE, &style);
  hdUpdateCalibration(static_cast<HDenum>(style));
  EXPECT_EQ(hdCheckCalibration(), HD_CALIBRATION_OK);
  EXPECT_EQ(hdCheckCalibrationStyle(), static_cast<HDenum>(HD_CALIBRATION_AUTO));
  hdUpdateCalibration(0);
  EXPECT_EQ(hdGetError().errorCode, HD_INVALID_VALUE);
}

TEST_F(CompatHd, FrameShowsOneTickAndThePreviousFrame) {
  ExecRig rig({.arms = {{.arm_file = "polhem"}}, .scene = "", .hand = "path"});
  hdInitDevice(nullptr);
  std::array<double, 3> before{}, now{}, later{}, last{};
  hdBeginFrame(0);
  hdGetDoublev(HD_CURRENT_GIMBAL_ANGLES, before.data());
  hdEndFrame(0);
  ExecRig::wait(0, 100);
  hdBeginFrame(0);
  hdGetDoublev(HD_CURRENT_GIMBAL_ANGLES, now.data());
  hdGetDoublev(HD_LAST_GIMBAL_ANGLES, last.data());
  ExecRig::wait(0, 100);
  hdGetDoublev(HD_CURRENT_GIMBAL_ANGLES, later.data());
  hdEndFrame(0);
  EXPECT_EQ(now, later);
  EXPECT_EQ(last, before);
  EXPECT_NE(now, before) << "the hand turns the stylus";
  hdGetDoublev(HD_CURRENT_GIMBAL_ANGLES, later.data());
  EXPECT_NE(now, later) << "outside of a frame, the newest tick is returned";
}

TEST_F(CompatHd, RefusesMismatchedFrames) {
  ExecRig rig;
  hdInitDevice(nullptr);
  const std::array<double, 3> f{0.1, 0, 0};
  hdSetDoublev(HD_CURRENT_FORCE, f.data());
  EXPECT_EQ(hdGetError().errorCode, HD_FRAME_ERROR);
  hdEndFrame(0);
  EXPECT_EQ(hdGetError().errorCode, HD_ILLEGAL_END);
  hdBeginFrame(0);
  hdBeginFrame(0);
  EXPECT_EQ(hdGetError().errorCode, HD_ILLEGAL_BEGIN);
  hdEndFrame(0);
  EXPECT_EQ(hdGetError().errorCode, HD_SUCCESS);
  hdBeginFrame(7);
  EXPECT_EQ(hdGetError().errorCode, HD_BAD_HANDLE);
  hdEndFrame(HD_INVALID_HANDLE);
  EXPECT_EQ(hdGetError().errorCode, HD_BAD_HANDLE);
}

TEST_F(CompatHd, ReturnsTheNewestErrorFirst) {
  ExecRig rig({.arms = {{.arm_file = "vintage_phantom"}, {.arm_file = "falcon"}}});
  ASSERT_EQ(hdInitDevice("falcon"), 1u);
  hdEndFrame(1);
  hdEnable(0x1234);
  const HDErrorInfo newest = hdGetError();
  EXPECT_EQ(newest.errorCode, HD_INVALID_ENUM);
  EXPECT_EQ(newest.hHD, 1u);
  EXPECT_EQ(newest.internalErrorCode, 0);
  EXPECT_TRUE(HD_DEVICE_ERROR(newest));
  EXPECT_EQ(hdGetError().errorCode, HD_ILLEGAL_END);
  EXPECT_EQ(hdGetError().errorCode, HD_SUCCESS);
  static_assert(sizeof(HDErrorInfo) == 12);
}

TEST_F(CompatHd, RampsTheForceIfEnabled) {
  ExecRig rig;
  hdInitDevice(nullptr);
  const double rate = 0.5;  // N/s
  hdSetDoublev(HD_FORCE_RAMPING_RATE, &rate);
  hdEnable(HD_FORCE_RAMPING);
  hdEnable(HD_FORCE_OUTPUT);
  const std::array<double, 3> f{0, 0.3, 0};
  double half = 0;
  int tick = 0;
  ArmReading begin, now;
  arms::read(0, begin);
  hd_frames(0, 500, [&] {
    hdSetDoublev(HD_CURRENT_FORCE, f.data());
    arms::read(0, now);
    if (++tick > 10) {
      const double since = 1e-9 * static_cast<double>(now.time_ns - begin.time_ns);
      EXPECT_LE(std::abs(now.f_client_W[2]), rate * since + 5e-3);
    }
    if (tick == 200) half = now.f_client_W[2];
  });
  EXPECT_GT(half, 0.05);
  hd_frames(0, 300, [&] { hdSetDoublev(HD_CURRENT_FORCE, f.data()); });
  EXPECT_NEAR(rig.motors.force_W().z(), 0.3, kQuantum);
}

TEST_F(CompatHd, ReportsForcesLimitedByTheGate) {
  ExecRig rig;
  hdInitDevice(nullptr);
  hdEnable(HD_FORCE_OUTPUT);
  std::map<HDerror, int> seen;
  const std::array<double, 3> f{0, 30, 0};
  hd_frames(0, 60, [&] {
    hdSetDoublev(HD_CURRENT_FORCE, f.data());
    for (HDErrorInfo e = hdGetError(); HD_DEVICE_ERROR(e); e = hdGetError()) ++seen[e.errorCode];
  });
  EXPECT_GT(seen[HD_EXCEEDED_MAX_FORCE], 0);
}

TEST_F(CompatHd, ClampsTheForceWithoutErrorIfEnabled) {
  ExecRig rig;
  hdInitDevice(nullptr);
  hdEnable(HD_MAX_FORCE_CLAMPING);
  hdEnable(HD_FORCE_OUTPUT);
  std::map<HDerror, int> seen;
  const std::array<double, 3> f{0, 30, 0};
  double highest = 0;
  ArmReading reading;
  hd_frames(0, 40, [&] {
    hdSetDoublev(HD_CURRENT_FORCE, f.data());
    arms::read(0, reading);
    highest = std::max(highest, reading.f_client_W[2]);
    for (HDErrorInfo e = hdGetError(); HD_DEVICE_ERROR(e); e = hdGetError()) ++seen[e.errorCode];
  });
  EXPECT_EQ(seen[HD_EXCEEDED_MAX_FORCE], 0);
  EXPECT_DOUBLE_EQ(highest, arms::facts(0).force_max);
}

TEST_F(CompatHd, ReportsAFaultUntilForceIsEnabledAgain) {
  ExecRig rig;
  hdInitDevice(nullptr);
  hdEnable(HD_FORCE_OUTPUT);
  const std::array<double, 3> none{std::nan(""), 0, 0}, f{0.1, 0, 0};
  hd_frames(0, 3, [&] { hdSetDoublev(HD_CURRENT_FORCE, none.data()); });
  std::map<HDerror, int> seen;
  hd_frames(0, 20, [&] {
    hdSetDoublev(HD_CURRENT_FORCE, f.data());
    for (HDErrorInfo e = hdGetError(); HD_DEVICE_ERROR(e); e = hdGetError()) ++seen[e.errorCode];
  });
  EXPECT_EQ(seen[HD_DEVICE_FAULT], 1);
  EXPECT_EQ(rig.motors.force_W().norm(), 0);
  hdEnable(HD_FORCE_OUTPUT);
  hd_frames(0, 700, [&] { hdSetDoublev(HD_CURRENT_FORCE, f.data()); });
  EXPECT_NEAR(rig.motors.force_W().y(), 0.1, kQuantum);
}

TEST_F(CompatHd, AppliesTheSpeedLimitOfTheProgram) {
  ExecRig rig({.hand = THIMBLE_SOURCE_DIR "/tests/compat/fast_hand.txt"});
  hdInitDevice(nullptr);
  hdEnable(HD_FORCE_OUTPUT);
  const double slow = 20;  // mm/s; the hand moves ten times as fast
  hdSetDoublev(HD_SOFTWARE_VELOCITY_LIMIT, &slow);
  std::map<HDerror, int> seen;
  hd_frames(0, 300, [&] {
    for (HDErrorInfo e = hdGetError(); HD_DEVICE_ERROR(e); e = hdGetError()) ++seen[e.errorCode];
  });
  EXPECT_EQ(seen[HD_EXCEEDED_MAX_VELOCITY], 1);
}

TEST_F(CompatHd, JacobianMatchesTheMotionOfTheTip) {
  ExecRig rig({.hand = THIMBLE_SOURCE_DIR "/tests/compat/fast_hand.txt"});
  hdInitDevice(nullptr);
  ExecRig::wait(0, 150);
  std::array<double, 36> J{}, J2{};
  std::array<double, 3> q{}, p{}, q2{}, p2{};
  hdBeginFrame(0);
  hdGetDoublev(HD_CURRENT_JACOBIAN, J.data());
  hdGetDoublev(HD_CURRENT_JOINT_ANGLES, q.data());
  hdGetDoublev(HD_CURRENT_POSITION, p.data());
  hdEndFrame(0);
  ExecRig::wait(0, 15);
  hdBeginFrame(0);
  hdGetDoublev(HD_CURRENT_JACOBIAN, J2.data());
  hdGetDoublev(HD_CURRENT_JOINT_ANGLES, q2.data());
  hdGetDoublev(HD_CURRENT_POSITION, p2.data());
  hdEndFrame(0);
  double moved = 0;
  for (std::size_t row = 0; row < 3; ++row) {
    double predicted = 0;
    for (std::size_t k = 0; k < 3; ++k)
      predicted += 0.5 * (J[6 * row + k] + J2[6 * row + k]) * (q2[k] - q[k]);
    EXPECT_NEAR(predicted, p2[row] - p[row], 0.1) << "mm, row " << row;
    moved += std::abs(p2[row] - p[row]);
  }
  EXPECT_GT(moved, 0.5) << "mm";
}

TEST_F(CompatHd, ConvertsJointTorquesToTipForce) {
  ExecRig rig;
  hdInitDevice(nullptr);
  hdEnable(HD_FORCE_OUTPUT);
  const std::array<double, 3> tau{10, -5, 8};  // N mm
  std::array<double, 3> made{};
  hd_frames(0, 400, [&] { hdSetDoublev(HD_CURRENT_JOINT_TORQUE, tau.data()); });
  hdGetDoublev(HD_CURRENT_JOINT_TORQUE, made.data());
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(made[i], tau[i], 0.5);
}

TEST_F(CompatHd, ReturnsNumbersInAllFiveTypes) {
  ExecRig rig;
  hdInitDevice(nullptr);
  HDint i = 0;
  HDlong l = 0;
  HDfloat f = 0;
  HDdouble d = 0;
  HDboolean b = 7;
  hdGetIntegerv(HD_UPDATE_RATE, &i);
  hdGetLongv(HD_UPDATE_RATE, &l);
  hdGetFloatv(HD_NOMINAL_MAX_STIFFNESS, &f);
  hdGetDoublev(HD_NOMINAL_MAX_STIFFNESS, &d);
  hdGetBooleanv(HD_CURRENT_SAFETY_SWITCH, &b);
  EXPECT_EQ(i, 1000);
  EXPECT_EQ(l, 1000);
  EXPECT_FLOAT_EQ(f, 0.8f) << "N/mm, of the arm's file";
  EXPECT_DOUBLE_EQ(d, 0.8);
  EXPECT_EQ(b, HD_TRUE);
  hdGetDoublev(HD_NOMINAL_MAX_CONTINUOUS_FORCE, &d);
  EXPECT_DOUBLE_EQ(d, 1.4) << "N, of the arm's file";
  std::array<double, 6> box{};
  hdGetDoublev(HD_USABLE_WORKSPACE_DIMENSIONS, box.data());
  EXPECT_EQ(box, (std::array<double, 6>{-100, -100, -100, 100, 100, 100}));
  EXPECT_STREQ(hdGetString(HD_DEVICE_VENDOR), "Thimble");
  EXPECT_STREQ(hdGetString(HD_DEVICE_MODEL_TYPE), "vintage_phantom");
}

TEST_F(CompatHd, ContinuousForceDefaultsToMaximumForce) {
  ExecRig rig({.arms = {{.arm_file = "falcon"}}});
  hdInitDevice(nullptr);
  HDdouble max_force = 0, continuous = 0;
  hdGetDoublev(HD_NOMINAL_MAX_FORCE, &max_force);
  hdGetDoublev(HD_NOMINAL_MAX_CONTINUOUS_FORCE, &continuous);
  EXPECT_EQ(max_force, 8);
  EXPECT_EQ(continuous, max_force);
}

TEST_F(CompatHd, ErrorWithoutAnArmNamesThimbleExec) {
  use_channel(nullptr);
  ::testing::internal::CaptureStderr();
  EXPECT_EQ(hdInitDevice(nullptr), HD_INVALID_HANDLE);
  EXPECT_EQ(hdGetError().errorCode, HD_COMM_ERROR);
  EXPECT_NE(::testing::internal::GetCapturedStderr().find("hdInitDevice: "), std::string::npos);
}

}  // namespace
}  // namespace thimble::compat
