// Requested and measured forces.
#include "compat/dhd/forces.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "compat/dhd/last_error.h"
#include "compat/dhd/open_arms.h"
#include "drdc.h"

namespace thimble::compat::dhd {
namespace {

constexpr double kVibrationMax = 500;  // Hz: half the rate of a loop of 1 kHz

std::array<double, 3> array_of(const Eigen::Vector3d& v) noexcept {
  return {v.x(), v.y(), v.z()};
}

// A watchdog set by the program latches as on the original arm: the force stays off until it is
// enabled again. The core's own watchdog lets the force return.
void latch_watchdog(OpenArm& arm, const ArmReading& reading) noexcept {
  if (arm.watchdog != 0 && reading.stalled && arm.force_sent && arm.force == ForceSwitch::kOn) {
    switch_off(arm, kOffByWatchdog);
  }
}

}  // namespace

int send_force(const char* function, OpenArm& arm, const Eigen::Vector3d& f_U,
               const Eigen::Vector3d& torque_U, double gripper) noexcept {
  ArmReading reading;
  if (!read_arm(function, arm, reading)) return -1;
  latch_watchdog(arm, reading);
  enable_force_if_unset(arm);
  const Eigen::Matrix3d R_WU = user_rotation(arm).transpose();
  Eigen::Vector3d f_W = R_WU * f_U;
  if (const double amplitude = arm.vibration_amplitude; amplitude != 0) {
    const double turns = arm.vibration_frequency * 1e-9 * static_cast<double>(reading.time_ns);
    f_W.z() += amplitude * std::sin(2 * std::numbers::pi * (turns - std::floor(turns)));
  }
  const bool finite = f_W.allFinite() && torque_U.allFinite() && std::isfinite(gripper);
  if (arm.force != ForceSwitch::kOn && finite)
    f_W.setZero();  // as if the arm's force switch were off
  ForceRequest asked{
      .f_W = array_of(f_W), .torque_W = array_of(R_WU * torque_U), .gripper = gripper};
  if (!finite) {
    // The gate treats NaN as a fault and latches it: a program with such a force is wrong.
    asked = {.f_W = {std::nan(""), std::nan(""), std::nan("")}};
  }
  if (!arms::ask_force(arm.number, asked)) {
    return fail(function, DHD_ERROR_COM, "the run of thimble exec has ended");
  }
  arm.forces.fetch_add(1, std::memory_order_relaxed);
  if (!arms::wait_until_taken(arm.number) && !arms::is_running(arm.number)) {
    return fail(function, DHD_ERROR_COM, "the run of thimble exec has ended");
  }
  arm.force_sent = true;
  if (!finite) return fail(function, DHD_ERROR_INVALID, "the force is not finite");
  double max_force = arms::facts(arm.number).force_max;
  if (const double own = arm.max_force; own >= 0) max_force = std::min(max_force, own);
  return f_W.norm() > max_force ? DHD_MOTOR_SATURATED : 0;
}

}  // namespace thimble::compat::dhd

using namespace thimble::compat;
using namespace thimble::compat::dhd;

namespace {

int ask(const char* function, char id, const Eigen::Vector3d& f_U, const Eigen::Vector3d& torque_U,
        double gripper) noexcept {
  OpenArm* arm = open_arm(function, id);
  if (!arm) return -1;
  if (arm->init_started.exchange(false)) arm->regulator.stop();
  if (arm->regulator.running()) {
    if (arm->regulator.regulates()) {
      return fail(function, DHD_ERROR_DEVICE_IN_USE, "the arm is regulated");
    }
    return drdSetForceAndTorqueAndGripperForce(
        std::array<double, DHD_MAX_DOF>{f_U.x(), f_U.y(), f_U.z(), torque_U.x(), torque_U.y(),
                                        torque_U.z(), gripper, 0}
            .data(),
        id);
  }
  return send_force(function, *arm, f_U, torque_U, gripper);
}

int put_force(const char* function, char id, std::array<double*, 3> force,
              std::array<double*, 4> rest, int rests) noexcept {
  const OpenArm* arm = open_arm(function, id);
  if (!arm) return -1;
  const auto null = [](const double* p) { return p == nullptr; };
  if (std::any_of(force.begin(), force.end(), null) ||
      std::any_of(rest.begin(), rest.begin() + rests, null)) {
    return fail(function, DHD_ERROR_NULL_ARGUMENT, "a pointer is null");
  }
  ArmReading reading;
  if (!read_arm(function, *arm, reading)) return -1;
  const Eigen::Vector3d f_U = user_rotation(*arm) * vector_of(reading.f_sent_W);
  for (std::size_t i = 0; i < 3; ++i) *force[i] = f_U[static_cast<Eigen::Index>(i)];
  // Our arms have no motors for wrist or gripper.
  for (int i = 0; i < rests; ++i) *rest[static_cast<std::size_t>(i)] = 0;
  return 0;
}

}  // namespace

extern "C" {

int dhdSetForce(double x, double y, double z, char id) {
  return ask("dhdSetForce", id, {x, y, z}, {0, 0, 0}, 0);
}
int dhdSetForceAndTorque(double fx, double fy, double fz, double tx, double ty, double tz,
                         char id) {
  return ask("dhdSetForceAndTorque", id, {fx, fy, fz}, {tx, ty, tz}, 0);
}
int dhdSetForceAndGripperForce(double fx, double fy, double fz, double gripper, char id) {
  return ask("dhdSetForceAndGripperForce", id, {fx, fy, fz}, {0, 0, 0}, gripper);
}
int dhdSetForceAndTorqueAndGripperForce(double fx, double fy, double fz, double tx, double ty,
                                        double tz, double gripper, char id) {
  return ask("dhdSetForceAndTorqueAndGripperForce", id, {fx, fy, fz}, {tx, ty, tz}, gripper);
}

// Torques of the wrist's joints are counted like a torque: our arms have no motors for them.
int dhdSetForceAndWristJointTorques(double fx, double fy, double fz, double t0, double t1,
                                    double t2, char id) {
  return ask("dhdSetForceAndWristJointTorques", id, {fx, fy, fz}, {t0, t1, t2}, 0);
}
int dhdSetForceAndWristJointTorquesAndGripperForce(double fx, double fy, double fz, double t0,
                                                   double t1, double t2, double gripper, char id) {
  return ask("dhdSetForceAndWristJointTorquesAndGripperForce", id, {fx, fy, fz}, {t0, t1, t2},
             gripper);
}

int dhdSetVibration(double frequency, double amplitude, int, char id) {
  OpenArm* arm = open_arm("dhdSetVibration", id);
  if (!arm) return -1;
  if (!(frequency >= 0 && frequency <= kVibrationMax) || !std::isfinite(amplitude)) {
    return fail("dhdSetVibration", DHD_ERROR_INVALID, "expected 0 to 500 Hz and a finite force");
  }
  arm->vibration_frequency = frequency;
  arm->vibration_amplitude = amplitude;
  return 0;
}

int dhdGetForce(double* x, double* y, double* z, char id) {
  return put_force("dhdGetForce", id, {x, y, z}, {}, 0);
}
int dhdGetForceAndTorque(double* fx, double* fy, double* fz, double* tx, double* ty, double* tz,
                         char id) {
  return put_force("dhdGetForceAndTorque", id, {fx, fy, fz}, {tx, ty, tz, nullptr}, 3);
}
int dhdGetForceAndTorqueAndGripperForce(double* fx, double* fy, double* fz, double* tx, double* ty,
                                        double* tz, double* gripper, char id) {
  return put_force("dhdGetForceAndTorqueAndGripperForce", id, {fx, fy, fz}, {tx, ty, tz, gripper},
                   4);
}

double dhdGetComFreq(char id) {
  OpenArm* arm = open_arm("dhdGetComFreq", id);
  if (!arm) return -1.0;
  const std::int64_t now_ns = arms::now_ns();
  const std::uint64_t forces = arm->forces;
  const std::lock_guard lock(arm->gap_mutex);
  const std::int64_t passed_ns = now_ns - arm->counted_ns;
  const std::uint64_t sent = forces - arm->counted_forces;
  const bool first = arm->counted_ns == 0;
  arm->counted_ns = now_ns;
  arm->counted_forces = forces;
  return first || passed_ns <= 0 ? 0.0
                                 : 1e6 * static_cast<double>(sent) / static_cast<double>(passed_ns);
}

}  // extern "C"
