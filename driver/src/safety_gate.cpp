#include "thimble/driver/safety_gate.h"

#include <cmath>

namespace thimble::driver {

SafetyGate::SafetyGate(const GateLimits& limits) noexcept : limits_(limits) {}

void SafetyGate::restart() noexcept {
  fault_ = Fault::kNone;
  since_start_ = 0;
  last_magnitude_ = 0;
}

void SafetyGate::trip(Fault fault) noexcept {
  if (fault_ == Fault::kNone) fault_ = fault;
}

GatedForce SafetyGate::pass(const Eigen::Vector3d& f_T_W, const Eigen::Vector3d& v_WT,
                            double dt) noexcept {
  // Every comparison is written so that NaN takes the safe branch.
  const double magnitude = f_T_W.norm();
  if (!(magnitude < HUGE_VAL)) trip(Fault::kForceNotFinite);
  const double speed = v_WT.norm();
  if (!(speed < HUGE_VAL)) trip(Fault::kStateNotFinite);
  if (!(speed <= limits_.speed_max)) trip(Fault::kOverSpeed);
  if (dt * 1e9 >= static_cast<double>(limits_.watchdog_ns)) trip(Fault::kLoopStalled);
  if (fault_ != Fault::kNone) {
    last_magnitude_ = 0;
    return GatedForce();
  }

  if (dt * 1e9 >= static_cast<double>(limits_.stall_ns)) {
    ++counters_.stalls;
    since_start_ = 0;
    last_magnitude_ = 0;
    dt = 0;
  }
  since_start_ += dt;

  double allowed = magnitude;
  if (allowed > limits_.force_max) {
    allowed = limits_.force_max;
    ++counters_.limited;
  }
  const double risen = last_magnitude_ + limits_.rise_max * dt;
  if (allowed > risen) {
    allowed = risen;
    ++counters_.rise_limited;
  }
  if (since_start_ < limits_.soft_start) {
    const double open = limits_.force_max * since_start_ / limits_.soft_start;
    if (allowed > open) {
      allowed = open;
      ++counters_.soft_started;
    }
  }
  last_magnitude_ = allowed;
  return magnitude > allowed ? GatedForce(f_T_W * (allowed / magnitude)) : GatedForce(f_T_W);
}

}  // namespace thimble::driver
