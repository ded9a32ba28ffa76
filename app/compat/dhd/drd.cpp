// The functions drd...: regulation of an arm's position.
#include <cmath>
#include <ctime>

#include "compat/dhd/last_error.h"
#include "compat/dhd/open_arms.h"
#include "drdc.h"

using namespace thimble::compat;
using namespace thimble::compat::dhd;

namespace {

// Returns the arm that `id` names, if its regulation runs. Otherwise returns null and records an
// error.
OpenArm* regulated_arm(const char* function, char id) noexcept {
  OpenArm* arm = open_arm(function, id);
  if (!arm) return nullptr;
  if (arm->regulator.running()) return arm;
  fail(function, DHD_ERROR_NO_REGULATION, "regulation is not running");
  return nullptr;
}

// Converts a point of the program to the world. If it is outside of the arm's workspace, returns
// false and records an error.
bool goal_of(const char* function, const OpenArm& arm, const Eigen::Vector3d& p_U,
             Eigen::Vector3d& p_W) noexcept {
  if (!p_U.allFinite()) {
    fail(function, DHD_ERROR_INVALID, "a number is not finite");
    return false;
  }
  p_W = user_rotation(arm).transpose() * p_U;
  const ArmFacts facts = arms::facts(arm.number);
  const bool inside = (p_W.array() >= vector_of(facts.workspace_min).array()).all() &&
                      (p_W.array() <= vector_of(facts.workspace_max).array()).all();
  if (!inside) fail(function, DHD_ERROR_GEOMETRY, "the point is outside the workspace of the arm");
  return inside;
}

// Result of a motion that was waited for.
enum class Arrival : std::uint8_t { kArrived, kTimeout, kStopped, kRunOver };

// Moves the tip to a point (m, world) and waits until the regulation has ended the motion.
Arrival move_and_wait(OpenArm& arm, const Eigen::Vector3d& p_W) noexcept {
  constexpr double kSpare = 1;  // s, for a regulation whose thread is late
  ArmReading reading;
  if (!arms::read(arm.number, reading)) return Arrival::kRunOver;
  const std::int64_t begin_ns = reading.time_ns;
  const double longest = arm.regulator.time_to(p_W, vector_of(reading.p_WT)) + kSpare;
  arm.regulator.move_to(p_W);
  while (arm.regulator.running() && arm.regulator.moving()) {
    if (1e-9 * static_cast<double>(reading.time_ns - begin_ns) > longest) return Arrival::kTimeout;
    arms::wait_for_tick(arm.number, reading.tick);
    if (!arms::is_running(arm.number) || !arms::read(arm.number, reading)) {
      return Arrival::kRunOver;
    }
  }
  if (arm.regulator.arrived()) return Arrival::kArrived;
  return arm.regulator.running() ? Arrival::kTimeout : Arrival::kStopped;
}

int move(const char* function, char id, const Eigen::Vector3d& p_U, bool wait) noexcept {
  OpenArm* arm = regulated_arm(function, id);
  Eigen::Vector3d p_W;
  if (!arm || !goal_of(function, *arm, p_U, p_W)) return -1;
  if (!arm->regulator.regulates()) {
    return fail(function, DHD_ERROR_NO_REGULATION, "drdRegulatePos is off");
  }
  if (!wait) {
    arm->regulator.move_to(p_W);
    return 0;
  }
  switch (move_and_wait(*arm, p_W)) {
    case Arrival::kArrived:
      return 0;
    case Arrival::kTimeout:
      return fail(function, DHD_ERROR_TIMEOUT, "the arm did not reach the point in time");
    case Arrival::kStopped:
      return fail(function, DHD_ERROR_NO_REGULATION,
                  "regulation was stopped before the arm reached the point");
    case Arrival::kRunOver:
      break;
  }
  return fail(function, DHD_ERROR_COM, "the run of thimble exec has ended");
}

int follow(const char* function, char id, const Eigen::Vector3d& p_U) noexcept {
  OpenArm* arm = regulated_arm(function, id);
  Eigen::Vector3d p_W;
  if (!arm || !goal_of(function, *arm, p_U, p_W)) return -1;
  if (!arm->regulator.regulates()) {
    return fail(function, DHD_ERROR_NO_REGULATION, "drdRegulatePos is off");
  }
  arm->regulator.track(p_W);
  return 0;
}

int set_bounds(const char* function, char id, void (Regulator::*set)(const PathBounds&) noexcept,
               const PathBounds& bounds) noexcept {
  OpenArm* arm = open_arm(function, id);
  if (!arm) return -1;
  if (!is_valid(bounds)) {
    return fail(function, DHD_ERROR_INVALID, "a bound is not finite and positive");
  }
  (arm->regulator.*set)(bounds);
  return 0;
}

// Sets the force of a released tip: force, torque and gripper.
int set_free_force(const char* function, char id, const double* force) noexcept {
  OpenArm* arm = regulated_arm(function, id);
  if (!arm) return -1;
  if (!force) return fail(function, DHD_ERROR_NULL_ARGUMENT, "a pointer is null");
  for (int i = 0; i < 7; ++i) {
    if (!std::isfinite(force[i]))
      return fail(function, DHD_ERROR_INVALID, "a number is not finite");
  }
  const Eigen::Matrix3d R_WU = user_rotation(*arm).transpose();
  const Eigen::Vector3d f_W = R_WU * Eigen::Vector3d(force[0], force[1], force[2]);
  const Eigen::Vector3d torque_W = R_WU * Eigen::Vector3d(force[3], force[4], force[5]);
  arm->regulator.set_free_force({.f_W = {f_W.x(), f_W.y(), f_W.z()},
                                 .torque_W = {torque_W.x(), torque_W.y(), torque_W.z()},
                                 .gripper = force[6]});
  arms::wait_until_taken(arm->number);
  return 0;
}

int get_bounds(const char* function, char id, PathBounds (Regulator::*get)() noexcept,
               double* acceleration, double* speed, double* jerk) noexcept {
  OpenArm* arm = open_arm(function, id);
  if (!arm) return -1;
  if (!acceleration || !speed || !jerk)
    return fail(function, DHD_ERROR_NULL_ARGUMENT, "a pointer is null");
  const PathBounds bounds = (arm->regulator.*get)();
  *acceleration = bounds.acceleration, *speed = bounds.speed, *jerk = bounds.jerk;
  return 0;
}

}  // namespace

extern "C" {

bool drdIsSupported(char id) {
  return open_arm("drdIsSupported", id) != nullptr;
}

// Our arms are calibrated before they can be opened.
bool drdIsInitialized(char id) {
  return open_arm("drdIsInitialized", id) != nullptr;
}
// On a simulated arm, moves the tip to the middle of its workspace and holds it there, as such an
// initialization does. The arm is initialized in any case, also if a hand holds it. A real arm is
// not moved.
int drdAutoInit(char id) {
  OpenArm* arm = open_arm("drdAutoInit", id);
  if (!arm) return -1;
  const ArmFacts facts = arms::facts(arm->number);
  if (!facts.simulated) return 0;
  const bool ran = arm->regulator.running();
  if (drdStart(id) != 0) return -1;
  arm->init_started = !ran;
  const Eigen::Vector3d middle_W =
      (vector_of(facts.workspace_min) + vector_of(facts.workspace_max)) / 2;
  if (move_and_wait(*arm, middle_W) != Arrival::kRunOver) return 0;
  return fail("drdAutoInit", DHD_ERROR_COM, "the run of thimble exec has ended");
}
int drdCheckInit(char id) {
  return open_arm("drdCheckInit", id) ? 0 : -1;
}
int drdPrecisionInit(char id) {
  return open_arm("drdPrecisionInit", id) ? 0 : -1;
}

int drdStart(char id) {
  OpenArm* arm = open_arm("drdStart", id);
  if (!arm) return -1;
  if (!enable_force_if_unset(*arm)) {
    return fail("drdStart", DHD_ERROR_NOT_ENABLED, "force is disabled");
  }
  arm->init_started = false;
  if (!arm->regulator.start(arm->number))
    return fail("drdStart", DHD_ERROR, "the thread cannot be created");
  return 0;
}

int drdStop(bool leave_force_on, char id) {
  OpenArm* arm = open_arm("drdStop", id);
  if (!arm) return -1;
  arm->regulator.stop();
  // After drdStop switched the force off, drdStart or the next force may switch it on.
  if (!leave_force_on && arm->force == ForceSwitch::kOn) {
    switch_off(*arm, kOffBySoftware);
    arm->force = ForceSwitch::kUnset;
  }
  return 0;
}

bool drdIsRunning(char id) {
  const OpenArm* arm = open_arm("drdIsRunning", id);
  return arm && arm->regulator.running();
}
bool drdIsMoving(char id) {
  const OpenArm* arm = open_arm("drdIsMoving", id);
  return arm && arm->regulator.moving();
}
bool drdIsFiltering(char id) {
  const OpenArm* arm = open_arm("drdIsFiltering", id);
  return arm && arm->regulator.filters();
}

int drdWaitForTick(char id) {
  const OpenArm* arm = regulated_arm("drdWaitForTick", id);
  ArmReading reading;
  if (!arm || !read_arm("drdWaitForTick", *arm, reading)) return -1;
  if (arms::wait_for_tick(arm->number, reading.tick)) return 0;
  return fail("drdWaitForTick", DHD_ERROR_COM, "the run of thimble exec has ended");
}

double drdGetCtrlFreq(char id) {
  const OpenArm* arm = open_arm("drdGetCtrlFreq", id);
  if (!arm) return -1.0;
  return arm->regulator.running() ? arms::facts(arm->number).rate / 1000 : 0.0;
}

int drdRegulatePos(bool on, char id) {
  OpenArm* arm = open_arm("drdRegulatePos", id);
  if (!arm) return -1;
  arm->regulator.regulate(on);
  arm->init_started = false;
  return 0;
}
// Our arms have no motors for wrist or gripper: accepted without effect.
int drdRegulateRot(bool, char id) {
  return open_arm("drdRegulateRot", id) ? 0 : -1;
}
int drdRegulateGrip(bool, char id) {
  return open_arm("drdRegulateGrip", id) ? 0 : -1;
}

int drdEnableFilter(bool on, char id) {
  OpenArm* arm = open_arm("drdEnableFilter", id);
  if (!arm) return -1;
  arm->regulator.filter(on);
  return 0;
}

int drdSetMotRatioMax(double ratio, char id) {
  OpenArm* arm = open_arm("drdSetMotRatioMax", id);
  if (!arm) return -1;
  if (!(ratio >= 0 && ratio <= 1))
    return fail("drdSetMotRatioMax", DHD_ERROR_INVALID, "the ratio is not between 0 and 1");
  arm->regulator.set_force_ratio(ratio);
  return 0;
}
double drdGetMotRatioMax(char id) {
  const OpenArm* arm = open_arm("drdGetMotRatioMax", id);
  return arm ? arm->regulator.force_ratio() : -1.0;
}

int drdMoveToPos(double x, double y, double z, bool wait, char id) {
  return move("drdMoveToPos", id, {x, y, z}, wait);
}
int drdMoveTo(double* goal, bool wait, char id) {
  if (!open_arm("drdMoveTo", id)) return -1;
  if (!goal) return fail("drdMoveTo", DHD_ERROR_NULL_ARGUMENT, "a pointer is null");
  return move("drdMoveTo", id, {goal[0], goal[1], goal[2]}, wait);
}
int drdTrackPos(double x, double y, double z, char id) {
  return follow("drdTrackPos", id, {x, y, z});
}
int drdTrack(double* goal, char id) {
  if (!open_arm("drdTrack", id)) return -1;
  if (!goal) return fail("drdTrack", DHD_ERROR_NULL_ARGUMENT, "a pointer is null");
  return follow("drdTrack", id, {goal[0], goal[1], goal[2]});
}
int drdHold(char id) {
  OpenArm* arm = regulated_arm("drdHold", id);
  if (!arm) return -1;
  arm->regulator.hold();
  return 0;
}

int drdSetPosMoveParam(double acceleration, double speed, double jerk, char id) {
  return set_bounds("drdSetPosMoveParam", id, &Regulator::set_move_bounds,
                    {acceleration, speed, jerk});
}
int drdGetPosMoveParam(double* acceleration, double* speed, double* jerk, char id) {
  return get_bounds("drdGetPosMoveParam", id, &Regulator::move_bounds, acceleration, speed, jerk);
}
int drdSetPosTrackParam(double acceleration, double speed, double jerk, char id) {
  return set_bounds("drdSetPosTrackParam", id, &Regulator::set_track_bounds,
                    {acceleration, speed, jerk});
}
int drdGetPosTrackParam(double* acceleration, double* speed, double* jerk, char id) {
  return get_bounds("drdGetPosTrackParam", id, &Regulator::track_bounds, acceleration, speed, jerk);
}

int drdSetForceAndTorqueAndGripperForce(double* force, char id) {
  return set_free_force("drdSetForceAndTorqueAndGripperForce", id, force);
}
// Torques of the wrist's joints are counted like a torque: our arms have no motors for them.
int drdSetForceAndWristJointTorquesAndGripperForce(double* force, char id) {
  return set_free_force("drdSetForceAndWristJointTorquesAndGripperForce", id, force);
}

}  // extern "C"
