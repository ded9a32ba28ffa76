#pragma once

#include <Eigen/Core>
#include <atomic>
#include <cstdint>

#include "thimble/driver/device_state.h"

namespace thimble::session {

/// Fraction of gravity compensation that is applied, depending on whether the tip moves along its
/// force.
///
/// A correct compensation does not move a free tip. An incorrect one (another weight, a tilted
/// base, a wrong sign) makes it run away. A hand may move the tip as well, so motion is neither
/// proof nor a fault:
/// - On trial, in the first second, the compensation is switched off if the tip moves kTrialWay
///   along its force.
/// - Later the compensation fades with the speed along its force, between kFadeBegins and
///   kFadeEnds, so that an incorrect one cannot accelerate the tip beyond that. It is switched off
///   if the tip moves kFastWay at more than kFast.
/// - It is not switched off while a law requests another force, which explains the motion.
/// - A compensation that was switched off returns, on trial, once the tip has been at rest for
///   kRest.
/// Fading never reduces the force against the motion, so that it adds no energy.
/// All functions are Real-time: safe; `withdrawn` from any thread.
class CompensationTrust {
 public:
  // [chosen: an arm that is released with twice its weight compensated moves 10 mm in 50 ms; a hand
  // that holds a grip still, as requested at the start, stays within a few]
  static constexpr double kTrial = 1, kTrialWay = 0.01;                // s, m
  static constexpr double kFadeBegins = 0.3, kFadeEnds = 0.6;          // m/s: a brisk stroke
  static constexpr double kFast = 0.45, kFastWay = 0.04;               // m/s, m
  static constexpr double kRestSpeed = 0.02, kRest = 0.5, kRamp = 20;  // m/s, s, 1/s

  /// Starts a trial.
  void restart() noexcept;

  /// Returns the fraction of the force `f_W` (N, in the world) to apply in this tick; `others`: a
  /// law requests another force.
  double share(const driver::DeviceState& state, const Eigen::Vector3d& f_W, bool others) noexcept;

  /// Returns how often the compensation was switched off.
  std::uint64_t withdrawn() const noexcept { return withdrawn_.load(std::memory_order_relaxed); }

 private:
  void judge(double along, double dt, bool others) noexcept;

  Eigen::Vector3d p_last_W_{0, 0, 0};  // m
  Eigen::Vector3d v_W_{0, 0, 0};       // Own estimate, independent of the filter of the state, m/s.
  bool begun_ = false;
  bool away_ = false;
  double share_ = 1;
  double trial_ = 0;  // Duration of the trial, s.
  double rest_ = 0;   // Time at rest while switched off, s.
  double way_ = 0;    // Displacement along the force, m.
  std::atomic<std::uint64_t> withdrawn_{0};
};

}  // namespace thimble::session
