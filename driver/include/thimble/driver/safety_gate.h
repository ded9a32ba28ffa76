#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>

#include "thimble/driver/energy_guard.h"
#include "thimble/driver/export.h"
#include "thimble/driver/fault.h"

namespace thimble::driver {

/// A force that has passed the safety gate: the only force that can become motor currents. Any code
/// can create zero force; only SafetyGate creates another.
class GatedForce {
 public:
  /// Constructs zero force.
  GatedForce() = default;

  /// Returns the force on the hand in the world frame, N.
  const Eigen::Vector3d& f_T_W() const noexcept { return f_T_W_; }

 private:
  friend class SafetyGate;
  explicit GatedForce(const Eigen::Vector3d& f_T_W) noexcept : f_T_W_(f_T_W) {}
  Eigen::Vector3d f_T_W_{0, 0, 0};
};

/// Limits of the force of an arm on a hand. Only the power limit can be switched off. The others
/// can be raised, but only within a range that still protects a person.
struct GateLimits {
  /// Shortest soft start, s [chosen: below 50 ms a hand feels no ramp but a knock: a stretch reflex
  /// responds after 30 to 50 ms M].
  static constexpr double kSoftStartMin = 0.05;
  /// Fastest rise, N/s [chosen: 100 N in a tick of 1 ms, more than any arm here can exert].
  static constexpr double kRiseMax = 1e5;
  /// Shortest time to the whole force, s. `rise_max` may be at most `kRiseMax` or `force_max /
  /// kRiseTimeMin`, whichever is larger [chosen: a tick of the fastest loop here, 20 kHz].
  static constexpr double kRiseTimeMin = 5e-5;
  /// Longest gap between ticks that is not a fault, ns [chosen: twice the longest watchdog of a
  /// board, 0.5 s of the mbed one (woody_report.h)].
  static constexpr std::int64_t kWatchdogMax_ns = 1'000'000'000;
  /// Largest force limit, N [chosen: twenty times what a desk-top arm exerts; a misplaced decimal
  /// point is detected].
  static constexpr double kForceMax = 100;
  /// Largest speed limit, m/s [chosen: twice what a hand reaches in a throw M].
  static constexpr double kSpeedMax = 20;

  /// Former name of kSoftStartMin.
  [[deprecated("renamed to kSoftStartMin")]] static constexpr double kSoftStartLeast =
      kSoftStartMin;
  /// Former name of kRiseMax.
  [[deprecated("renamed to kRiseMax")]] static constexpr double kRiseMost = kRiseMax;
  /// Former name of kRiseTimeMin.
  [[deprecated("renamed to kRiseTimeMin")]] static constexpr double kRiseTimeLeast = kRiseTimeMin;
  /// Former name of kWatchdogMax_ns.
  [[deprecated("renamed to kWatchdogMax_ns")]] static constexpr std::int64_t kWatchdogMost_ns =
      kWatchdogMax_ns;
  /// Former name of kForceMax.
  [[deprecated("renamed to kForceMax")]] static constexpr double kForceMost = kForceMax;
  /// Former name of kSpeedMax.
  [[deprecated("renamed to kSpeedMax")]] static constexpr double kSpeedMost = kSpeedMax;

  double force_max = 0;  ///< Largest force, N. Must be finite and > 0.
  double speed_max = 0;  ///< Tip speed above which the force is switched off until a restart, m/s.
  /// Fastest change of the force vector, N/s. A decrease of its magnitude is never slowed. A
  /// remainder of the old force that would give the hand more power than the requested force is
  /// reduced at once (limit_rise in gate/safety_gate.cpp).
  double rise_max = 0;
  double soft_start = 0;  ///< Time over which the limit opens from 0 to `force_max`, s.
  /// Time over which the limit opens after a gap, when the hand may already be in contact, s. A
  /// surface that is absent for longer is felt as gone [PHYSICS 7, case 9: back within 50 ms].
  double reopen = 0.04;
  /// Gap between ticks after which the limit opens again from 0, ns.
  std::int64_t stall_ns = 0;
  /// Gap between ticks after which the arm's own watchdog has fired, ns. Such a gap is a fault.
  /// SafetyGate lowers this limit to five times `stall_ns` if it is higher.
  std::int64_t watchdog_ns = 0;
  /// Mean power on the hand above which the force is reduced, W; the force is zero at `kPowerFade`
  /// times that. 0: not limited.
  double power_max = 0;
  double power_time = 2;  ///< Time constant of that mean, s.
  /// Mean power at which the force is zero, as a multiple of `power_max` [chosen: the force fades
  /// smoothly, but the limit is exceeded only slightly].
  static constexpr double kPowerFade = 1.2;
};

/// Counters of the ticks in which each stage of the gate changed the force.
struct GateCounters {
  std::uint64_t limited = 0;        ///< Ticks limited to `force_max`.
  std::uint64_t rise_limited = 0;   ///< Ticks limited by `rise_max`, in magnitude or direction.
  std::uint64_t soft_started = 0;   ///< Ticks limited by the soft start.
  std::uint64_t stalls = 0;         ///< Gaps after which the limit opened again.
  std::uint64_t damped = 0;         ///< Ticks damped by the passivity controller.
  std::uint64_t bounded = 0;        ///< Ticks limited by the energy bound.
  std::uint64_t power_limited = 0;  ///< Ticks reduced because the mean power was at its limit.
  /// Ticks in which the program's part of the force (EnergyFlow::f_program_W) was reduced after an
  /// oscillation.
  std::uint64_t calmed = 0;
  /// Number of growing oscillations of a program's force; not ticks.
  std::uint64_t oscillations = 0;
  double oscillation_frequency = 0;  ///< Frequency of the last oscillation, Hz.
  double power_max = 0;              ///< Largest mean power on the hand, W.
  double min_energy = 0;             ///< Lowest energy of the passivity observer, J; never above 0.
};

class ProgramWatch;

/// Safety gate between every force law and the motors. Its stages: reduction of a program's force
/// that oscillates -> finite -> speed limit -> time -> the arm's limit -> power limit -> soft start
/// -> energy stage, if one is named -> rise limit.
///
/// The rise limit is last, so that it also covers the output of the energy stage. It is one-sided:
/// a limit on the decrease as well would turn a passive wall into an active one (restitution up to
/// 2.7) [PHYSICS 1.6]. The soft start opens the arm's limit gradually. No later stage makes a force
/// larger than the limit opened so far.
///
/// The time of a tick must be finite and not negative, because all limits in time depend on it.
///
/// A fault latches: the gate then gives zero force until `restart`. All functions are Real-time:
/// safe.
class THIMBLE_EXPORT SafetyGate {
 public:
  /// Constructs a gate with these limits and energy stage. Real-time: never from the servo thread.
  explicit SafetyGate(const GateLimits& limits, const EnergyGuardSettings& energy = {});
  /// Moves the contents of another gate. The other gate can only be assigned to or destroyed after
  /// that.
  SafetyGate(SafetyGate&& other) noexcept;
  SafetyGate& operator=(SafetyGate&& other) noexcept;  ///< Moves the contents of another gate.
  SafetyGate(const SafetyGate&) = delete;
  SafetyGate& operator=(const SafetyGate&) = delete;
  ~SafetyGate();

  /// Clears the fault and the history, and starts the soft start.
  void restart() noexcept;

  /// Converts a requested force into one that may reach the motors. `f_T_W` in N, `v_WT` in m/s,
  /// both in the world. `dt` is the time since the previous call, s (0 on the first after
  /// `restart`; in such a tick the force does not rise). A `dt` that is negative or not finite is
  /// the fault kTimeNotMonotonic.
  GatedForce pass(const Eigen::Vector3d& f_T_W, const Eigen::Vector3d& v_WT, double dt) noexcept;

  /// Does the same and applies the energy stage. `flow` is the energy flow since the previous call.
  /// The stage may reduce the force or add damping to it. The result never exceeds the rise limit,
  /// nor the part of the arm's limit that the soft start has opened.
  GatedForce pass_guarded(const Eigen::Vector3d& f_T_W, const Eigen::Vector3d& v_WT, double dt,
                          const EnergyFlow& flow) noexcept;

  /// Restarts the soft start from zero force; keeps a fault.
  void close() noexcept;

  /// Updates the mean power: in a tick of `dt` (s), the force sent did `work` (J) on the hand. Call
  /// it before `pass` or `pass_guarded`.
  void book_power(double work, double dt) noexcept {
    // Written so that NaN is ignored.
    if (!(dt > 0 && std::abs(work) < HUGE_VAL)) return;
    power_ += (work - power_ * std::min(dt, limits_.power_time)) / limits_.power_time;
    if (power_ > counters_.power_max) counters_.power_max = power_;
  }

  /// Monitors a program's part of the force for a tick. Returns the fraction (0 to 1) of it that
  /// may be requested: below 1 after a growing oscillation. `f_program_W`: requested now, N;
  /// `p_WT`: the tip, m; both in the world. Call it before `pass` or `pass_guarded`.
  double program_share(const Eigen::Vector3d& f_program_W, const Eigen::Vector3d& p_WT,
                       double dt) noexcept;
  /// Returns the program's part of the last passed force, N in the world: a fraction of the part in
  /// EnergyFlow.
  const Eigen::Vector3d& f_program_W() const noexcept { return f_program_W_; }
  double power() const noexcept { return power_; }  ///< Returns the mean power on the hand, W.

  /// Sets the force from which the next rise is measured to `f_W` (N, in the world), because the
  /// arm did not accept the last force and this one still acts. A force that is not finite is used
  /// as zero.
  void resume_from(const Eigen::Vector3d& f_W) noexcept;

  /// Latches a fault detected by the caller; the first fault is kept.
  void trip(Fault fault) noexcept;

  Fault fault() const noexcept { return fault_; }  ///< Returns the reason why the force is off.
  const GateCounters& counters() const noexcept { return counters_; }
  const GateLimits& limits() const noexcept { return limits_; }  ///< Returns the limits.
  /// Returns the energy stage.
  EnergyStage energy_stage() const noexcept { return energy_.stage; }
  /// Returns the balance of the passivity observer, J.
  double energy() const noexcept { return observer_.energy(); }

 private:
  bool admit(double magnitude, const Eigen::Vector3d& v_WT, double dt) noexcept;
  Eigen::Vector3d limit_length(const Eigen::Vector3d& f_T_W, double magnitude) noexcept;
  GatedForce limit_change(const Eigen::Vector3d& f_W, const Eigen::Vector3d& v_WT) noexcept;
  double force_open() const noexcept;
  Eigen::Vector3d within_open(const Eigen::Vector3d& f_W) const noexcept;

  GateLimits limits_;
  GateCounters counters_;
  Fault fault_ = Fault::kNone;
  double since_start_ = 0;             // Active time since the limit began to open, s.
  double opening_ = 0;                 // Time of the opening, s.
  double rise_ = 0;                    // Force that may be added in this tick, N.
  Eigen::Vector3d f_last_W_{0, 0, 0};  // N
  EnergyGuardSettings energy_;
  PassivityObserver observer_;
  double power_ = 0;                       // W
  double power_limit_;                     // W, or infinite.
  Eigen::Vector3d f_program_W_{0, 0, 0};   // Part of f_last_W_, N.
  std::unique_ptr<ProgramWatch> program_;  // Empty only in a gate that was moved from.
};

}  // namespace thimble::driver
