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

/// Holds a force that passed the safety gate: the only force that can become motor currents. Anyone
/// may make the zero force; only SafetyGate makes another.
class GatedForce {
 public:
  /// Zero force.
  GatedForce() = default;

  /// Returns the force on the hand in the world frame, N.
  const Eigen::Vector3d& f_T_W() const noexcept { return f_T_W_; }

 private:
  friend class SafetyGate;
  explicit GatedForce(const Eigen::Vector3d& f_T_W) noexcept : f_T_W_(f_T_W) {}
  Eigen::Vector3d f_T_W_{0, 0, 0};
};

/// Sets what an arm may do to a hand. There is no "off": a limit is raised, never left out, and no
/// further than to where it still protects somebody.
struct GateLimits {
  /// Shortest soft start, s [chosen: below 50 ms a hand feels no ramp but a knock: a stretch reflex
  /// answers after 30 to 50 ms M].
  static constexpr double kSoftStartLeast = 0.05;
  /// Fastest rise, N/s [chosen: 100 N in a tick of 1 ms, more than any arm here can push].
  static constexpr double kRiseMost = 1e5;
  /// Or shortest time to the whole force, s, for a force so large that only a bench asks for it
  /// [chosen: a tick of the fastest loop here, 20 kHz].
  static constexpr double kRiseTimeLeast = 5e-5;
  /// Longest gap that is no fault, ns [chosen: twice the longest watchdog of a board, 0.5 s of the
  /// mbed one (woody_report.h)].
  static constexpr std::int64_t kWatchdogMost_ns = 1'000'000'000;
  /// Largest force, N [chosen: twenty times what a desk-top arm pushes; a slipped decimal point is
  /// caught].
  static constexpr double kForceMost = 100;
  /// Largest speed, m/s [chosen: twice what a hand reaches in a throw M].
  static constexpr double kSpeedMost = 20;

  double force_max = 0;  ///< Largest force, N. Must be finite and > 0.
  double speed_max = 0;  ///< Tip speed above which the force goes off and stays off, m/s.
  /// Fastest change of the force's vector, N/s. A fall of its length is never slowed, and an old
  /// force that would push the hand on goes at once (limit_rise in gate/safety_gate.cpp).
  double rise_max = 0;
  double soft_start = 0;  ///< Time over which the limit opens from 0 to `force_max`, s.
  /// The same after a gap, for somebody who is touching already, s; a hand feels a surface as gone
  /// if it is away for longer [PHYSICS 7, case 9: back within 50 ms].
  double reopen = 0.04;
  std::int64_t stall_ns = 0;     ///< Gap between ticks after which the limit opens anew, ns.
  std::int64_t watchdog_ns = 0;  ///< Gap after which the arm's own watchdog has fired: a fault, ns.
  /// Mean power on the hand above which the force is lowered, W; it is gone at `kPowerFade` times
  /// that. 0: not limited.
  double power_max = 0;
  double power_time = 2;  ///< Time constant of that mean, s.
  /// Mean power at which no force is left, over `power_max` [chosen: soft, and near].
  static constexpr double kPowerFade = 1.2;
};

/// Counts the ticks in which each stage of the gate changed the force.
struct GateCounters {
  std::uint64_t limited = 0;         ///< Cut to `force_max`.
  std::uint64_t rise_limited = 0;    ///< Held back by `rise_max`, in length or direction.
  std::uint64_t soft_started = 0;    ///< Cut by the soft start.
  std::uint64_t stalls = 0;          ///< Gaps after which the limit opened anew.
  std::uint64_t damped = 0;          ///< Damped by the passivity controller.
  std::uint64_t bounded = 0;         ///< Cut by the energy bound.
  std::uint64_t power_limited = 0;   ///< Lowered because the mean power was at its limit.
  std::uint64_t calmed = 0;          ///< A program's part lowered after an oscillation.
  std::uint64_t oscillations = 0;    ///< Growing oscillations of a program's force; not ticks.
  double oscillation_frequency = 0;  ///< Of the last of them, Hz.
  double power_max = 0;              ///< Largest mean power on the hand, W.
  double energy_least = 0;           ///< Lowest energy that the observer saw, J; never above 0.
};

class ProgramWatch;

/// Stands between every force law and the motors: a program's part without growing oscillations ->
/// finite -> speed limit -> time -> the arm's limit -> power limit -> soft start -> energy stage,
/// if one is named -> rise limit.
///
/// The rise limit comes last, so that it holds for whatever the energy stage adds. It is one-sided:
/// a limit on the fall as well would turn a passive wall into an active one (restitution up to 2.7)
/// [PHYSICS 1.6]. No stage behind the arm's limit makes a force longer than the limit, as far as
/// the soft start has opened it.
///
/// The time of a tick must be a finite number of zero or more: all limits in time follow from it.
///
/// A fault latches: from then on the gate gives zero force until `restart`.
/// All functions are Real-time: safe.
class THIMBLE_EXPORT SafetyGate {
 public:
  /// Real-time: never from the servo thread.
  explicit SafetyGate(const GateLimits& limits, const EnergyGuardSettings& energy = {});
  /// Takes all of another gate, which only an assignment may use after that.
  SafetyGate(SafetyGate&& other) noexcept;
  SafetyGate& operator=(SafetyGate&& other) noexcept;  ///< As above.
  SafetyGate(const SafetyGate&) = delete;
  SafetyGate& operator=(const SafetyGate&) = delete;
  ~SafetyGate();

  /// Forgets the fault and the past, and begins the soft start.
  void restart() noexcept;

  /// Turns a requested force into one that may reach the motors. `f_T_W` in N, `v_WT` in m/s, both
  /// in the world; `dt` is the time since the previous call, s (0 on the first after `restart`; in
  /// such a tick nothing rises). A `dt` below zero, or not finite, is the fault kTimeNotMonotonic.
  GatedForce pass(const Eigen::Vector3d& f_T_W, const Eigen::Vector3d& v_WT, double dt) noexcept;

  /// Does the same, and then keeps the energy in bounds: what the energy stage is for. `flow` tells
  /// what came of the call before. The stage may cut the force, or add damping to it, but never
  /// beyond the arm's limit as far as the soft start has opened it, nor faster than the rise limit
  /// allows.
  GatedForce pass_guarded(const Eigen::Vector3d& f_T_W, const Eigen::Vector3d& v_WT, double dt,
                          const EnergyFlow& flow) noexcept;

  /// Begins the soft start again, from no force, and keeps a fault.
  void close() noexcept;

  /// Lets a tick pass, in which the force that was sent did `work` (J) on the hand in `dt` (s): for
  /// the mean power. Before `pass` or `pass_guarded`.
  void book_power(double work, double dt) noexcept {
    // Written so that NaN is no power.
    if (!(dt > 0 && std::abs(work) < HUGE_VAL)) return;
    power_ += (work - power_ * std::min(dt, limits_.power_time)) / limits_.power_time;
    if (power_ > counters_.power_max) counters_.power_max = power_;
  }

  /// Follows a program's part of the force through a tick, and returns the share (0 to 1) of it
  /// that may be asked for: less than 1 after an oscillation that grew.
  /// `f_program_W`: asked for now, N; `p_WT`: the tip, m; both in the world. Before `pass` or
  /// `pass_guarded`.
  double program_share(const Eigen::Vector3d& f_program_W, const Eigen::Vector3d& p_WT,
                       double dt) noexcept;
  /// Returns the program's part of the force that passed last, N in the world: a share of what
  /// EnergyFlow named.
  const Eigen::Vector3d& f_program_W() const noexcept { return f_program_W_; }
  double power() const noexcept { return power_; }  ///< Returns the mean power on the hand, W.

  /// Counts the next rise from `f_W` (N, in the world): the arm did not take what passed last, and
  /// this is the force that stands. A force that is not finite counts as none.
  void resume_from(const Eigen::Vector3d& f_W) noexcept;

  /// Latches a fault that somebody else found; the first one stays.
  void trip(Fault fault) noexcept;

  Fault fault() const noexcept { return fault_; }  ///< Names what switched the force off.
  const GateCounters& counters() const noexcept { return counters_; }
  const GateLimits& limits() const noexcept { return limits_; }        ///< Its limits.
  EnergyStage energy_stage() const noexcept { return energy_.stage; }  ///< Names its energy stage.
  /// Returns the energy on the observer's account, J.
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
  double since_start_ = 0;             // s of active time since the limit began to open
  double opening_ = 0;                 // s that it takes
  double rise_ = 0;                    // N that may be added in this tick
  Eigen::Vector3d f_last_W_{0, 0, 0};  // N
  EnergyGuardSettings energy_;
  PassivityObserver observer_;
  double power_ = 0;                       // W
  double power_limit_;                     // W, or infinite
  Eigen::Vector3d f_program_W_{0, 0, 0};   // N, of f_last_W_
  std::unique_ptr<ProgramWatch> program_;  // never empty, but in a gate that was moved from
};

}  // namespace thimble::driver
