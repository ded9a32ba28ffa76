#include "support/mock/mock_dhd.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <thread>

using thimble::support::MockDhd;

namespace {

MockDhd& mock() {
  static MockDhd one;
  return one;
}

std::int64_t steady_ns() {
  return std::chrono::steady_clock::now().time_since_epoch().count();
}

/// A call of one function on the arm.
class Call {
 public:
  Call(const char* name, char id, bool needs_open = true) : lock_(mock().mutex), name_(name) {
    if (id != 0) wrong("with another arm's number");
    if (needs_open && !mock().open) wrong("before open or after close");
    if (mock().arm.time_ns == 0) mock().arm.time_ns = steady_ns();
    mock().arm.advance_to(steady_ns());
  }
  void wrong(const std::string& why) { mock().wrong.push_back(std::string(name_) + " " + why); }
  void expect(bool right, const char* why) {
    if (!right) wrong(why);
  }
  int answer() const { return mock().fails == name_ ? -1 : 0; }

 private:
  std::lock_guard<std::mutex> lock_;
  const char* name_;
};

}  // namespace

extern "C" {

MockDhd* mock_dhd() {
  return &mock();
}

int dhdGetDeviceCount() {
  const std::lock_guard lock(mock().mutex);
  return mock().arms;
}
void dhdGetSDKVersion(int* major, int* minor, int* release, int* revision) {
  *major = 3;
  *minor = 17;
  *release = 5;
  *revision = 0;
}
int dhdErrorGetLast() {
  return 2;
}
const char* dhdErrorGetLastStr() {
  return "failure requested by the test";
}
int drdOpenID(char id) {
  Call call("drdOpenID", id, false);
  call.expect(!mock().open, "twice");
  if (mock().held || call.answer() < 0) return -1;
  mock().open = true;
  ++mock().opened;
  return 0;
}
int drdClose(char id) {
  Call call("drdClose", id);
  call.expect(!mock().force_on, "with the forces on");
  mock().open = false;
  ++mock().closed;
  return call.answer();
}
bool drdIsInitialized(char id) {
  const Call call("drdIsInitialized", id);
  mock().asked_zero = true;
  return mock().initialised;
}
int drdAutoInit(char id) {
  Call call("drdAutoInit", id);
  ++mock().found_zero;
  if (call.answer() < 0) return -1;
  mock().initialised = true;
  return 0;
}
int drdStop(bool, char id) {
  return Call("drdStop", id).answer();
}
const char* dhdGetSystemName(char id) {
  const Call call("dhdGetSystemName", id);
  return "omega.3";
}
bool dhdHasWrist(char id) {
  const Call call("dhdHasWrist", id);
  return mock().wrist;
}
bool dhdHasGripper(char id) {
  const Call call("dhdHasGripper", id);
  return mock().gripper;
}
int dhdEnableExpertMode() {
  const std::lock_guard lock(mock().mutex);
  mock().expert = true;
  return 0;
}
int dhdDisableExpertMode() {
  const std::lock_guard lock(mock().mutex);
  mock().expert = false;
  return 0;
}
int dhdGetStatus(int status[17], char id) {
  const Call call("dhdGetStatus", id);
  std::fill_n(status, 17, 0);
  status[5] = mock().force_on && !mock().tripped ? 1 : 0;
  return call.answer();
}
int dhdSetWatchdog(unsigned char duration, char id) {
  Call call("dhdSetWatchdog", id);
  call.expect(mock().expert, "without expert functions");
  call.expect(duration > 0, "switches it off");
  call.expect(duration >= 80, "shorter than 10 ms");
  mock().watchdog = call.answer() == 0;
  return call.answer();
}
int dhdSetGravityCompensation(int on, char id) {
  const Call call("dhdSetGravityCompensation", id);
  mock().gravity = on != 0;
  return call.answer();
}
int dhdSetBrakes(int on, char id) {
  const Call call("dhdSetBrakes", id);
  mock().brakes = on != 0;
  return call.answer();
}
int dhdEnableForce(unsigned char on, char id) {
  Call call("dhdEnableForce", id);
  if (on != 0) {
    call.expect(mock().asked_zero && mock().initialised, "for an uninitialised arm");
    call.expect(mock().watchdog, "before the watchdog");
    call.expect(mock().gravity, "before gravity compensation");
    call.expect(!mock().brakes, "with the brakes on");
    call.expect(!mock().expert, "by an expert");
  } else {
    call.expect(mock().taken.empty() || mock().taken.back().isZero(0), "off during a force");
  }
  mock().force_on = on != 0 && call.answer() == 0;
  return call.answer();
}
int dhdStop(char id) {
  const Call call("dhdStop", id);
  ++mock().stopped;
  return call.answer();
}
int dhdGetPosition(double* x, double* y, double* z, char id) {
  const bool late = [] {
    const std::lock_guard lock(mock().mutex);
    return mock().late;
  }();
  // An exchange over USB.
  std::this_thread::sleep_for(late ? std::chrono::microseconds(60'000)
                                   : std::chrono::microseconds(250));
  const Call call("dhdGetPosition", id);
  const Eigen::Vector3d& p = mock().arm.p_BT;
  *x = mock().reports_nan ? std::numeric_limits<double>::quiet_NaN() : p.x();
  *y = p.y();
  *z = p.z();
  return call.answer();
}
int dhdGetLinearVelocity(double* x, double* y, double* z, char id) {
  const Call call("dhdGetLinearVelocity", id);
  const Eigen::Vector3d& v = mock().arm.v_BT;
  *x = v.x();
  *y = v.y();
  *z = v.z();
  return call.answer();
}
int dhdGetOrientationFrame(double frame[3][3], char id) {
  Call call("dhdGetOrientationFrame", id);
  call.expect(mock().wrist, "of an arm without a wrist");
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) frame[row][column] = mock().arm.R_BT(row, column);
  }
  return call.answer();
}
int dhdGetGripperGap(double* gap, char id) {
  Call call("dhdGetGripperGap", id);
  call.expect(mock().gripper, "of an arm without a gripper");
  *gap = mock().arm.gripper;
  return call.answer();
}
unsigned int dhdGetButtonMask(char id) {
  const Call call("dhdGetButtonMask", id);
  return mock().arm.buttons;
}
int dhdSetForce(double x, double y, double z, char id) {
  Call call("dhdSetForce", id);
  const Eigen::Vector3d f(x, y, z);
  call.expect(f.allFinite(), "with NaN or infinity");
  call.expect(f.isZero(0) || mock().force_on, "before the forces are on");
  if (call.answer() < 0) return -1;
  mock().arm.f_T_B = mock().tripped ? Eigen::Vector3d(0, 0, 0) : f;
  mock().taken.push_back(f);
  return 0;
}

}  // extern "C"
