#include "thimble/driver/safety_gate.h"

#include <algorithm>
#include <cmath>

namespace thimble::driver {

SafetyGate::SafetyGate(const GateLimits& limits, const EnergyGuardSettings& energy) noexcept
    : limits_(limits), opening_(limits.soft_start), energy_(energy), observer_(energy) {}

void SafetyGate::restart() noexcept {
  fault_ = Fault::kNone;
  since_start_ = 0;
  opening_ = limits_.soft_start;
  last_magnitude_ = 0;
  observer_.restart();
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
    // A first soft start that was not over stays as slow as it was.
    if (since_start_ >= opening_) opening_ = limits_.reopen;
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
  if (since_start_ < opening_) {
    const double open = limits_.force_max * since_start_ / opening_;
    if (allowed > open) {
      allowed = open;
      ++counters_.soft_started;
    }
  }
  last_magnitude_ = allowed;
  return magnitude > allowed ? GatedForce(f_T_W * (allowed / magnitude)) : GatedForce(f_T_W);
}

GatedForce SafetyGate::pass_guarded(const Eigen::Vector3d& f_T_W, const Eigen::Vector3d& v_WT,
                                    double dt, const EnergyFlow& flow) noexcept {
  // What was given is given, whatever becomes of this tick.
  observer_.book(flow.work, flow.held);
  if (!(std::abs(flow.work) + flow.move_W.squaredNorm() < HUGE_VAL)) trip(Fault::kStateNotFinite);
  GatedForce limited = pass(f_T_W, v_WT, dt);
  if (fault_ != Fault::kNone) return limited;
  Eigen::Vector3d f_W = limited.f_T_W();
  if (energy_.stage == EnergyStage::kBounding) {
    const double bound = bounded_force(flow, energy_.slope);
    const double magnitude = f_W.norm();
    if (magnitude <= bound) return limited;
    f_W *= bound / magnitude;
    ++counters_.bounded;
  } else if (energy_.stage == EnergyStage::kPassivity) {
    counters_.energy_least = std::min(counters_.energy_least, observer_.energy());
    const Eigen::Vector3d damping_W = observer_.damping(v_WT, dt);
    // A damper within its bounds cannot hold a wall that pushes on and on, slowly. So beyond the
    // onset the force fades with the debt, whatever the velocity seems to be, and at twice the
    // onset there is none left that could give energy. What the hand brings in brings it back.
    const double share = observer_.share(dt);
    if (!(share < 1) && damping_W.isZero(0)) return limited;
    f_W = share * f_W + damping_W;
    ++counters_.damped;
    const double open = limits_.force_max * std::min(1.0, since_start_ / opening_);
    const double magnitude = f_W.norm();
    if (magnitude > open) f_W *= open / magnitude;
  }
  last_magnitude_ = f_W.norm();
  return GatedForce(f_W);
}

}  // namespace thimble::driver
