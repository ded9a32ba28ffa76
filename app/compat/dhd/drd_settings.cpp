// Settings of the regulation: gains, and bounds of motions that our arms cannot make.
#include <cmath>

#include "compat/dhd/last_error.h"
#include "compat/dhd/open_arms.h"
#include "drdc.h"

using namespace thimble::compat;
using namespace thimble::compat::dhd;

namespace {

int set_stored(const char* function, char id, StoredMotion motion,
               const PathBounds& bounds) noexcept {
  OpenArm* arm = open_arm(function, id);
  if (!arm) return -1;
  if (!is_valid(bounds)) {
    return fail(function, DHD_ERROR_INVALID, "a bound is not finite and positive");
  }
  const std::lock_guard lock(arm->stored_mutex);
  arm->stored_bounds[static_cast<std::size_t>(motion)] = bounds;
  return 0;
}

int get_stored(const char* function, char id, StoredMotion motion, double* acceleration,
               double* speed, double* jerk) noexcept {
  OpenArm* arm = open_arm(function, id);
  if (!arm) return -1;
  if (!acceleration || !speed || !jerk) {
    return fail(function, DHD_ERROR_NULL_ARGUMENT, "a pointer is null");
  }
  const std::lock_guard lock(arm->stored_mutex);
  const PathBounds& bounds = arm->stored_bounds[static_cast<std::size_t>(motion)];
  *acceleration = bounds.acceleration, *speed = bounds.speed, *jerk = bounds.jerk;
  return 0;
}

// Returns the arm whose gain may become `gain`; otherwise records an error.
OpenArm* arm_for_gain(const char* function, char id, double gain) noexcept {
  OpenArm* arm = open_arm(function, id);
  if (!arm) return nullptr;
  if (std::isfinite(gain) && gain >= 0) return arm;
  fail(function, DHD_ERROR_INVALID, "the gain is negative or not finite");
  return nullptr;
}

// Motions of parts without motors are refused.
int refuse(const char* function, char id, const char* what) noexcept {
  return open_arm(function, id) ? fail(function, DHD_ERROR_NOT_AVAILABLE, what) : -1;
}
constexpr const char* kNoWrist = "the wrist has no motors";
constexpr const char* kNoGripper = "the gripper has no motor";

}  // namespace

// Setter and getter of the bounds of one motion.
#define THIMBLE_STORED_BOUNDS(part, motion)                                             \
  int drdSet##part##Param(double acceleration, double speed, double jerk, char id) {    \
    return set_stored("drdSet" #part "Param", id, motion, {acceleration, speed, jerk}); \
  }                                                                                     \
  int drdGet##part##Param(double* acceleration, double* speed, double* jerk, char id) { \
    return get_stored("drdGet" #part "Param", id, motion, acceleration, speed, jerk);   \
  }

extern "C" {

THIMBLE_STORED_BOUNDS(RotMove, StoredMotion::kRotMove)
THIMBLE_STORED_BOUNDS(RotTrack, StoredMotion::kRotTrack)
THIMBLE_STORED_BOUNDS(GripMove, StoredMotion::kGripMove)
THIMBLE_STORED_BOUNDS(GripTrack, StoredMotion::kGripTrack)
THIMBLE_STORED_BOUNDS(EncMove, StoredMotion::kEncMove)
THIMBLE_STORED_BOUNDS(EncTrack, StoredMotion::kEncTrack)

int drdSetEncPGain(double gain, char id) {
  OpenArm* arm = arm_for_gain("drdSetEncPGain", id, gain);
  if (!arm) return -1;
  arm->regulator.set_stiffness_gain(gain);
  return 0;
}
double drdGetEncPGain(char id) {
  const OpenArm* arm = open_arm("drdGetEncPGain", id);
  return arm ? arm->regulator.stiffness_gain() : -1.0;
}

int drdSetEncDGain(double gain, char id) {
  OpenArm* arm = arm_for_gain("drdSetEncDGain", id, gain);
  if (!arm) return -1;
  arm->regulator.set_damping_gain(gain);
  return 0;
}
double drdGetEncDGain(char id) {
  const OpenArm* arm = open_arm("drdGetEncDGain", id);
  return arm ? arm->regulator.damping_gain() : -1.0;
}

int drdSetEncIGain(double gain, char id) {
  OpenArm* arm = arm_for_gain("drdSetEncIGain", id, gain);
  if (!arm) return -1;
  arm->stored_integral_gain = gain;
  return 0;
}
double drdGetEncIGain(char id) {
  const OpenArm* arm = open_arm("drdGetEncIGain", id);
  return arm ? arm->stored_integral_gain.load() : -1.0;
}

int drdMoveToRot(double, double, double, bool, char id) {
  return refuse("drdMoveToRot", id, kNoWrist);
}
int drdTrackRot(double, double, double, char id) {
  return refuse("drdTrackRot", id, kNoWrist);
}
int drdMoveToGrip(double, bool, char id) {
  return refuse("drdMoveToGrip", id, kNoGripper);
}
int drdTrackGrip(double, char id) {
  return refuse("drdTrackGrip", id, kNoGripper);
}

}  // extern "C"
