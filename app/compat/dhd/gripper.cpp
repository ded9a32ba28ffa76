// The gripper and the buttons.
#include <numbers>

#include "compat/dhd/last_error.h"
#include "compat/dhd/open_arms.h"
#include "drdc.h"

using namespace thimble::compat;
using namespace thimble::compat::dhd;

namespace {

constexpr double kDegree = std::numbers::pi / 180;
// Length of a finger, m: an opening of 30 degrees, as clients expect of a gripper (CHAI3D), then
// gives a width of 31 mm [chosen].
constexpr double kFinger = 0.06;
// A gripper with a smaller opening than this presses its emulated button, m [chosen].
constexpr double kClosed = 0.005;

// Returns the arm with a gripper that `id` names, and its last state. If there is none, or
// `pointer` is null, returns null and records an error.
OpenArm* arm_with_gripper(const char* function, char id, const void* pointer,
                          ArmReading& reading) noexcept {
  OpenArm* arm = open_arm(function, id);
  if (!arm) return nullptr;
  if (!pointer) {
    fail(function, DHD_ERROR_NULL_ARGUMENT, "a pointer is null");
    return nullptr;
  }
  if (!arms::facts(arm->number).has_gripper) {
    fail(function, DHD_ERROR_NOT_AVAILABLE, "the arm has no gripper");
    return nullptr;
  }
  return read_arm(function, *arm, reading) ? arm : nullptr;
}

int put_gap(const char* function, char id, double* value, double scale) noexcept {
  ArmReading reading;
  if (!arm_with_gripper(function, id, value, reading)) return -1;
  *value = scale * static_cast<double>(reading.gripper);
  return 0;
}

// Writes the opening speed of the gripper, between two calls at least a tick apart.
int put_gap_speed(const char* function, char id, double* value, double scale) noexcept {
  ArmReading reading;
  OpenArm* arm = arm_with_gripper(function, id, value, reading);
  if (!arm) return -1;
  const double time = 1e-9 * static_cast<double>(reading.time_ns);
  const double gap = reading.gripper;
  const std::lock_guard lock(arm->gap_mutex);
  if (time > arm->gap_time) {
    if (arm->gap_time > 0) arm->gap_speed = (gap - arm->gap) / (time - arm->gap_time);
    arm->gap_time = time;
    arm->gap = gap;
  }
  *value = scale * arm->gap_speed;
  return 0;
}

// Writes the position of a finger: half the opening away from the tip, along the stylus' y axis.
int put_finger(const char* function, char id, double side, double* x, double* y,
               double* z) noexcept {
  ArmReading reading;
  const OpenArm* arm = arm_with_gripper(function, id, x && y && z ? x : nullptr, reading);
  if (!arm) return -1;
  const Eigen::Vector3d p_W = vector_of(reading.p_WT) + side / 2 *
                                                            static_cast<double>(reading.gripper) *
                                                            matrix_of(reading.R_WT).col(1);
  const Eigen::Vector3d p_U = user_rotation(*arm) * p_W;
  *x = p_U.x(), *y = p_U.y(), *z = p_U.z();
  return 0;
}

bool buttons_of(const char* function, char id, unsigned& buttons) noexcept {
  const OpenArm* arm = open_arm(function, id);
  ArmReading reading;
  if (!arm || !read_arm(function, *arm, reading)) return false;
  buttons = reading.buttons;
  if (arm->emulate_button && reading.gripper < kClosed) buttons |= 1;
  return true;
}

}  // namespace

extern "C" {

int dhdGetGripperGap(double* gap, char id) {
  return put_gap("dhdGetGripperGap", id, gap, 1);
}
int dhdGetGripperAngleRad(double* angle, char id) {
  return put_gap("dhdGetGripperAngleRad", id, angle, 1 / kFinger);
}
int dhdGetGripperAngleDeg(double* angle, char id) {
  return put_gap("dhdGetGripperAngleDeg", id, angle, 1 / (kFinger * kDegree));
}
int dhdGetGripperLinearVelocity(double* velocity, char id) {
  return put_gap_speed("dhdGetGripperLinearVelocity", id, velocity, 1);
}
int dhdGetGripperAngularVelocityRad(double* velocity, char id) {
  return put_gap_speed("dhdGetGripperAngularVelocityRad", id, velocity, 1 / kFinger);
}
int dhdGetGripperAngularVelocityDeg(double* velocity, char id) {
  return put_gap_speed("dhdGetGripperAngularVelocityDeg", id, velocity, 1 / (kFinger * kDegree));
}
int dhdGetGripperThumbPos(double* x, double* y, double* z, char id) {
  return put_finger("dhdGetGripperThumbPos", id, -1, x, y, z);
}
int dhdGetGripperFingerPos(double* x, double* y, double* z, char id) {
  return put_finger("dhdGetGripperFingerPos", id, 1, x, y, z);
}

int dhdGetButton(int index, char id) {
  unsigned buttons = 0;
  if (!open_arm("dhdGetButton", id)) return -1;
  if (index < 0 || index >= DHD_MAX_BUTTONS) {
    return fail("dhdGetButton", DHD_ERROR_INVALID_INDEX, "no button has this number");
  }
  if (!buttons_of("dhdGetButton", id, buttons)) return -1;
  return (buttons >> index) & 1 ? DHD_ON : DHD_OFF;
}

unsigned dhdGetButtonMask(char id) {
  unsigned buttons = 0;
  return buttons_of("dhdGetButtonMask", id, buttons) ? buttons : 0;
}

}  // extern "C"
