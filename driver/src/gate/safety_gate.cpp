#include "thimble/driver/safety_gate.h"

#include <algorithm>
#include <cmath>

#include "gate/program_watch.h"

namespace thimble::driver {

namespace {

/// Returns the limits of a gate for which a gap of five times the stall is a fault. This holds even
/// if the board's own watchdog waits longer (0.5 s on the mbed boards). [chosen: 0.1 s in all arm
/// files, the watchdog of the boards with text lines]
GateLimits with_gap(GateLimits limits) noexcept {
  limits.watchdog_ns = std::min(limits.watchdog_ns, 5 * std::max<std::int64_t>(limits.stall_ns, 1));
  return limits;
}

/// Returns the point on the segment from one force to another that is at most `rise` away.
Eigen::Vector3d towards(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                        double rise) noexcept {
  const Eigen::Vector3d way = to - from;
  const double length = way.norm();
  if (length <= rise) return to;
  return from + rise / length * way;
}

/// Returns the force that may follow `f_last_W` when `f_W` is requested: at most `rise` (N, >= 0)
/// is added to the rest of the old force, in any direction. All forces in N, in the world; `v_WT`
/// in m/s. All must be finite.
///
/// Usually the old force is held: it is shortened to the requested length, which is never delayed,
/// and moves towards the requested force by at most `rise`. Holding must not push a hand on: a slow
/// limit on the fall of a force makes a passive wall active [PHYSICS 1.6]. So if the held force
/// gives the hand more power than the requested one, a second candidate is computed. The old force
/// is reduced to the point between none and all of it that is nearest to the requested force, and
/// at most `rise` is added. The candidate that gives less power is sent. At a speed up to
/// `speed_floor` (m/s), which a flickering encoder count can imitate, the old force is held.
///
/// The sent force f' has these properties for any request:
/// - Its distance from the segment between 0 and `f_last_W` is at most `rise`: a part of the old
///   force may vanish at once, and at most `rise` is added.
/// - |f'| <= |f_last_W| + rise, which follows, and |f'| <= |f_W|. Both candidates end in the ball
///   about 0 through f_W: the first because the ball is convex, the second because it is the
///   nearest point to f_W of a convex set with 0 in it.
/// - f'.v <= f_W.v, or f'.v is at most that of the second candidate.
///
/// Verified by tests/unit/driver/gate/rise_limit_test.cpp. Real-time: safe.
Eigen::Vector3d limit_rise(const Eigen::Vector3d& f_W, const Eigen::Vector3d& f_last_W,
                           const Eigen::Vector3d& v_WT, double rise, double speed_floor) noexcept {
  const double square_now = f_W.squaredNorm();
  const double square_last = f_last_W.squaredNorm();
  const double kept = square_now < square_last ? std::sqrt(square_now / square_last) : 1;
  const Eigen::Vector3d held = towards(kept * f_last_W, f_W, rise);
  const double power_held = held.dot(v_WT);
  if (!(power_held > f_W.dot(v_WT)) || !(v_WT.squaredNorm() > speed_floor * speed_floor)) {
    return held;
  }
  const double share = square_last > 0 ? std::clamp(f_W.dot(f_last_W) / square_last, 0.0, 1.0) : 0;
  const Eigen::Vector3d dropped = towards(share * f_last_W, f_W, rise);
  return dropped.dot(v_WT) < power_held ? dropped : held;
}

}  // namespace

SafetyGate::SafetyGate(const GateLimits& limits, const EnergyGuardSettings& energy)
    : limits_(with_gap(limits)),
      opening_(limits.soft_start),
      energy_(energy),
      observer_(energy),
      power_limit_(limits.power_max > 0 ? limits.power_max : HUGE_VAL),
      program_(std::make_unique<ProgramWatch>(limits.force_max)) {}

SafetyGate::SafetyGate(SafetyGate&& other) noexcept = default;
SafetyGate& SafetyGate::operator=(SafetyGate&& other) noexcept = default;
SafetyGate::~SafetyGate() = default;

void SafetyGate::restart() noexcept {
  fault_ = Fault::kNone;
  since_start_ = 0;
  opening_ = limits_.soft_start;
  f_last_W_.setZero();
  f_program_W_.setZero();
  observer_.restart();
  program_->restart();
  power_ = 0;
}

double SafetyGate::program_share(const Eigen::Vector3d& f_program_W, const Eigen::Vector3d& p_WT,
                                 double dt) noexcept {
  const double share = program_->share(f_program_W, f_program_W_, p_WT, dt);
  counters_.oscillations = program_->oscillations();
  counters_.oscillation_frequency = program_->frequency();
  if (share < 1 && !f_program_W.isZero(0)) ++counters_.calmed;
  return share;
}

void SafetyGate::close() noexcept {
  since_start_ = 0;
  opening_ = limits_.soft_start;
  f_last_W_.setZero();
}

void SafetyGate::resume_from(const Eigen::Vector3d& f_W) noexcept {
  f_last_W_ = f_W.squaredNorm() < HUGE_VAL ? f_W : Eigen::Vector3d(0, 0, 0);
}

void SafetyGate::trip(Fault fault) noexcept {
  if (fault_ == Fault::kNone) fault_ = fault;
}

// Every comparison is written so that NaN takes the safe branch.

/// Checks all conditions that switch the force off, and advances the time of the tick.
inline bool SafetyGate::admit(double magnitude, const Eigen::Vector3d& v_WT, double dt) noexcept {
  if (!(magnitude < HUGE_VAL)) trip(Fault::kForceNotFinite);
  const double speed = v_WT.norm();
  if (!(speed < HUGE_VAL)) trip(Fault::kStateNotFinite);
  if (!(speed <= limits_.speed_max)) trip(Fault::kOverSpeed);
  if (!(dt >= 0 && dt * 1e9 < static_cast<double>(limits_.watchdog_ns))) {
    trip(dt >= 0 && dt < HUGE_VAL ? Fault::kLoopStalled : Fault::kTimeNotMonotonic);
  }
  if (fault_ != Fault::kNone) {
    f_last_W_.setZero();
    return false;
  }
  if (dt * 1e9 >= static_cast<double>(limits_.stall_ns)) {
    ++counters_.stalls;
    // If the first soft start was not complete, the next one is as slow.
    if (since_start_ >= opening_) opening_ = limits_.reopen;
    since_start_ = 0;
    f_last_W_.setZero();
    dt = 0;
  }
  since_start_ += dt;
  rise_ = limits_.rise_max * dt;
  return true;
}

/// Returns the force that the soft start allows now, N.
inline double SafetyGate::force_open() const noexcept {
  return limits_.force_max * since_start_ / opening_;
}

/// Returns a force, cut to the presently allowed one.
inline Eigen::Vector3d SafetyGate::within_open(const Eigen::Vector3d& f_W) const noexcept {
  const double open = std::min(limits_.force_max, force_open());
  const double magnitude = f_W.norm();
  return magnitude > open ? Eigen::Vector3d(f_W * (open / magnitude)) : f_W;
}

/// Returns the requested force, cut to the part of the arm's limit that the soft start allows.
inline Eigen::Vector3d SafetyGate::limit_length(const Eigen::Vector3d& f_T_W,
                                                double magnitude) noexcept {
  double allowed = magnitude;
  if (allowed > limits_.force_max) {
    allowed = limits_.force_max;
    ++counters_.limited;
  }
  // The mean power changes slowly, so the force does too.
  if (power_ > power_limit_ && allowed > 0) {
    const double beyond = (power_ / power_limit_ - 1) / (GateLimits::kPowerFade - 1);
    allowed *= std::max(0.0, 1 - beyond);
    ++counters_.power_limited;
  }
  if (since_start_ < opening_) {
    const double open = force_open();
    if (allowed > open) {
      allowed = open;
      ++counters_.soft_started;
    }
  }
  return magnitude > allowed ? Eigen::Vector3d(f_T_W * (allowed / magnitude)) : f_T_W;
}

/// Makes the force to send, within the rise limit of the last one.
inline GatedForce SafetyGate::limit_change(const Eigen::Vector3d& f_W,
                                           const Eigen::Vector3d& v_WT) noexcept {
  // A usual tick ends here. A shorter force of the same direction may be further away.
  if ((f_W - f_last_W_).squaredNorm() <= rise_ * rise_) {
    f_last_W_ = f_W;
    return GatedForce(f_W);
  }
  f_last_W_ = limit_rise(f_W, f_last_W_, v_WT, rise_, energy_.speed_floor);
  if (f_last_W_ != f_W) ++counters_.rise_limited;
  return GatedForce(f_last_W_);
}

GatedForce SafetyGate::pass(const Eigen::Vector3d& f_T_W, const Eigen::Vector3d& v_WT,
                            double dt) noexcept {
  const double magnitude = f_T_W.norm();
  if (!admit(magnitude, v_WT, dt)) return GatedForce();
  return limit_change(limit_length(f_T_W, magnitude), v_WT);
}

GatedForce SafetyGate::pass_guarded(const Eigen::Vector3d& f_T_W, const Eigen::Vector3d& v_WT,
                                    double dt, const EnergyFlow& flow) noexcept {
  // Energy that was already given is booked, independent of this tick.
  observer_.book(flow);
  if (!(std::abs(flow.work) + flow.move_W.squaredNorm() < HUGE_VAL)) trip(Fault::kStateNotFinite);
  const double requested = f_T_W.norm();
  f_program_W_.setZero();
  if (!admit(requested, v_WT, dt)) return GatedForce();
  Eigen::Vector3d f_W = limit_length(f_T_W, requested);
  // A program's force passes the stage unchanged: its stored energy is unknown.
  const bool program = (flow.f_program_W.array() != 0).any();
  if (program && requested > 0) f_program_W_ = f_W.norm() / requested * flow.f_program_W;
  if (energy_.stage == EnergyStage::kBounding) {
    const double bound = bounded_force(flow, energy_.slope);
    if (program) f_W -= f_program_W_;
    const double magnitude = f_W.norm();
    if (!(magnitude <= bound)) {
      f_W *= bound / magnitude;
      ++counters_.bounded;
    }
    if (program) f_W = within_open(f_W + f_program_W_);
  } else if (energy_.stage == EnergyStage::kPassivity) {
    counters_.min_energy = std::min(counters_.min_energy, observer_.energy());
    const Eigen::Vector3d damping_W = observer_.damping(v_WT, dt);
    // A damper within its bounds cannot stop a wall that keeps pushing slowly. So beyond the onset
    // the force fades with the debt, independent of the measured velocity, and at twice the onset
    // no force remains that could give energy. Energy from the hand restores the force.
    const double share = observer_.share(dt);
    if (share < 1 || (damping_W.array() != 0).any()) {
      f_W = share * (f_W - f_program_W_) + f_program_W_ + damping_W;
      ++counters_.damped;
      f_W = within_open(f_W);
    }
  }
  const GatedForce passed = limit_change(f_W, v_WT);
  if (program) {
    const double length = f_W.norm();
    if (length > 0) f_program_W_ *= std::min(1.0, f_last_W_.norm() / length);
  }
  return passed;
}

}  // namespace thimble::driver
