// Settings of an arm: force on and off, angles, masses, limits.
#include <cmath>
#include <numbers>

#include "compat/dhd/last_error.h"
#include "compat/dhd/open_arms.h"
#include "drdc.h"

using namespace thimble::compat;
using namespace thimble::compat::dhd;

namespace {

constexpr double kDegree = std::numbers::pi / 180;

std::atomic<bool> expert{false};

int set_number(const char* function, char id, std::atomic<double> OpenArm::*where, double value) {
  OpenArm* arm = open_arm(function, id);
  if (!arm) return -1;
  if (!std::isfinite(value)) return fail(function, DHD_ERROR_INVALID, "a number is not finite");
  (arm->*where) = value;
  return 0;
}

int get_number(const char* function, char id, std::atomic<double> OpenArm::*where, double* value,
               double unit) {
  const OpenArm* arm = open_arm(function, id);
  if (!arm) return -1;
  if (!value) return fail(function, DHD_ERROR_NULL_ARGUMENT, "a pointer is null");
  *value = (arm->*where) / unit;
  return 0;
}

int set_flag(const char* function, char id, std::atomic<bool> OpenArm::*where, bool value) {
  OpenArm* arm = open_arm(function, id);
  if (!arm) return -1;
  (arm->*where) = value;
  return 0;
}

}  // namespace

extern "C" {

int dhdStop(char id) {
  OpenArm* arm = open_arm("dhdStop", id);
  if (!arm) return -1;
  arm->regulator.stop();
  switch_off(*arm, kOffBySoftware);
  return 0;
}

int dhdEnableForce(unsigned char on, char id) {
  OpenArm* arm = open_arm("dhdEnableForce", id);
  if (!arm) return -1;
  if (on == DHD_OFF) {
    switch_off(*arm, kOffBySoftware);
    return 0;
  }
  // Discards earlier requests.
  arms::ask_force(arm->number, {});
  arm->force_sent = false;
  if (!arms::enable_force(arm->number, true)) {
    return fail("dhdEnableForce", DHD_ERROR_DEVICE_NOT_READY, "a fault keeps the force off");
  }
  arm->force = ForceSwitch::kOn;
  return 0;
}

// Our arms are calibrated before they can be opened: there is nothing to reset or wait for.
int dhdReset(char id) {
  return open_arm("dhdReset", id) ? 0 : -1;
}

int dhdWaitForReset(int timeout_ms, char id) {
  if (!open_arm("dhdWaitForReset", id)) return -1;
  return timeout_ms >= 0 ? 0 : fail("dhdWaitForReset", DHD_ERROR_INVALID, "the time is negative");
}

// The next three cause no force: our arms support their own weight (README.md).
int dhdSetGravityCompensation(int on, char id) {
  return set_flag("dhdSetGravityCompensation", id, &OpenArm::gravity, on != DHD_OFF);
}
int dhdSetBrakes(int on, char id) {
  return set_flag("dhdSetBrakes", id, &OpenArm::brakes, on != DHD_OFF);
}
int dhdSetEffectorMass(double mass, char id) {
  if (mass < 0 && open_arm("dhdSetEffectorMass", id)) {
    return fail("dhdSetEffectorMass", DHD_ERROR_INVALID, "the mass is negative");
  }
  return set_number("dhdSetEffectorMass", id, &OpenArm::effector_mass, mass);
}
int dhdGetEffectorMass(double* mass, char id) {
  return get_number("dhdGetEffectorMass", id, &OpenArm::effector_mass, mass, 1);
}

int dhdSetDeviceAngleRad(double angle, char id) {
  return set_number("dhdSetDeviceAngleRad", id, &OpenArm::device_angle, angle);
}
int dhdSetDeviceAngleDeg(double angle, char id) {
  return set_number("dhdSetDeviceAngleDeg", id, &OpenArm::device_angle, angle * kDegree);
}
int dhdGetDeviceAngleRad(double* angle, char id) {
  return get_number("dhdGetDeviceAngleRad", id, &OpenArm::device_angle, angle, 1);
}
int dhdGetDeviceAngleDeg(double* angle, char id) {
  return get_number("dhdGetDeviceAngleDeg", id, &OpenArm::device_angle, angle, kDegree);
}
int dhdSetBaseAngleXRad(double angle, char id) {
  return set_number("dhdSetBaseAngleXRad", id, &OpenArm::base_angle_x, angle);
}
int dhdSetBaseAngleXDeg(double angle, char id) {
  return set_number("dhdSetBaseAngleXDeg", id, &OpenArm::base_angle_x, angle * kDegree);
}
int dhdGetBaseAngleXRad(double* angle, char id) {
  return get_number("dhdGetBaseAngleXRad", id, &OpenArm::base_angle_x, angle, 1);
}
int dhdGetBaseAngleXDeg(double* angle, char id) {
  return get_number("dhdGetBaseAngleXDeg", id, &OpenArm::base_angle_x, angle, kDegree);
}
int dhdSetBaseAngleZRad(double angle, char id) {
  return set_number("dhdSetBaseAngleZRad", id, &OpenArm::base_angle_z, angle);
}
int dhdSetBaseAngleZDeg(double angle, char id) {
  return set_number("dhdSetBaseAngleZDeg", id, &OpenArm::base_angle_z, angle * kDegree);
}
int dhdGetBaseAngleZRad(double* angle, char id) {
  return get_number("dhdGetBaseAngleZRad", id, &OpenArm::base_angle_z, angle, 1);
}
int dhdGetBaseAngleZDeg(double* angle, char id) {
  return get_number("dhdGetBaseAngleZDeg", id, &OpenArm::base_angle_z, angle, kDegree);
}

int dhdEmulateButton(unsigned char on, char id) {
  OpenArm* arm = open_arm("dhdEmulateButton", id);
  if (!arm) return -1;
  // Switching off a button that an arm cannot have succeeds.
  if (on != DHD_OFF && !arms::facts(arm->number).has_gripper) {
    return fail("dhdEmulateButton", DHD_ERROR_NOT_AVAILABLE, "the arm has no gripper");
  }
  arm->emulate_button = on != DHD_OFF;
  return 0;
}

int dhdSetMaxForce(double newtons, char id) {
  OpenArm* arm = open_arm("dhdSetMaxForce", id);
  if (!arm) return -1;
  if (!std::isfinite(newtons)) {
    return fail("dhdSetMaxForce", DHD_ERROR_INVALID, "a number is not finite");
  }
  // Zero would mean the gate's limit, so a limit of zero is a force too small to be felt.
  const double limit = newtons < 0 ? 0 : std::max(newtons, 1e-9);
  if (!arms::set_force_limit(arm->number, limit)) {
    return fail("dhdSetMaxForce", DHD_ERROR_COM, "the run of thimble exec has ended");
  }
  arm->max_force = newtons < 0 ? -1 : newtons;
  return 0;
}

double dhdGetMaxForce(char id) {
  const OpenArm* arm = open_arm("dhdGetMaxForce", id);
  return arm ? arm->max_force.load() : -1.0;
}

int dhdEnableExpertMode(void) {
  expert = true;
  return 0;
}
int dhdDisableExpertMode(void) {
  expert = false;
  return 0;
}

int dhdSetWatchdog(unsigned char steps, char id) {
  OpenArm* arm = open_arm("dhdSetWatchdog", id);
  if (!arm) return -1;
  if (!expert) return fail("dhdSetWatchdog", DHD_ERROR_EXPERT_MODE_DISABLED, "expert mode is off");
  if (!arms::set_watchdog(arm->number, std::int64_t{steps} * 125'000)) {
    return fail("dhdSetWatchdog", DHD_ERROR_COM, "the run of thimble exec has ended");
  }
  arm->watchdog = steps;
  return 0;
}

int dhdGetWatchdog(unsigned char* steps, char id) {
  const OpenArm* arm = open_arm("dhdGetWatchdog", id);
  if (!arm) return -1;
  if (!steps) return fail("dhdGetWatchdog", DHD_ERROR_NULL_ARGUMENT, "a pointer is null");
  *steps = arm->watchdog;
  return 0;
}

int dhdSetVelocityThreshold(unsigned speed, char id) {
  OpenArm* arm = open_arm("dhdSetVelocityThreshold", id);
  if (!arm) return -1;
  if (!expert) {
    return fail("dhdSetVelocityThreshold", DHD_ERROR_EXPERT_MODE_DISABLED, "expert mode is off");
  }
  if (!arms::set_speed_limit(arm->number, speed)) {
    return fail("dhdSetVelocityThreshold", DHD_ERROR_COM, "the run of thimble exec has ended");
  }
  arm->velocity_threshold = speed;
  return 0;
}

int dhdGetVelocityThreshold(unsigned* speed, char id) {
  const OpenArm* arm = open_arm("dhdGetVelocityThreshold", id);
  if (!arm) return -1;
  if (!speed) return fail("dhdGetVelocityThreshold", DHD_ERROR_NULL_ARGUMENT, "a pointer is null");
  *speed = arm->velocity_threshold;
  return 0;
}

// Functions that bypass the gate or the arm's calibration are refused in expert mode, too.
int dhdPreset(int*, unsigned char, char id) {
  if (!open_arm("dhdPreset", id)) return -1;
  return fail("dhdPreset", DHD_ERROR_NOT_AVAILABLE, "calibration is defined by the arm file");
}
int dhdSetMot(unsigned short*, unsigned char, char id) {
  if (!open_arm("dhdSetMot", id)) return -1;
  return fail("dhdSetMot", DHD_ERROR_NOT_AVAILABLE,
              "the motors accept forces only through the safety gate");
}

}  // extern "C"

namespace thimble::compat::dhd {
bool expert_mode() noexcept {
  return expert;
}
}  // namespace thimble::compat::dhd
