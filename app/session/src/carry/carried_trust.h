#pragma once

#include <Eigen/Core>
#include <atomic>
#include <cstdint>

#include "thimble/driver/device_state.h"

namespace thimble::session {

/// How far the force that carries an arm's weight is trusted: by whether the tip moves with it.
///
/// A right one holds a free tip where it is, so that nothing moves along it by itself.
/// A wrong one (another weight, a tilted base, a wrong sign) makes a free tip run away. A hand may
/// move the tip as well, so that motion is no proof and no fault:
/// - On trial, in the first second, a tip that goes kTrialWay along the force takes it away.
/// - Later the force fades with the speed along it, between kFadeBegins and kFadeEnds, so that a
///   wrong one makes no tip faster than that; and a tip that goes kFastWay at more than kFast
///   takes it away. While a law asks for a force of its own, that explains the motion.
/// - A force that was taken away comes back, on trial, once the tip has rested for kRest.
/// Against the motion it is never less than whole, so that its share gives no energy.
/// All functions are Real-time: safe; `withdrawn` from any thread.
class CarriedTrust {
 public:
  // [chosen: an arm that was let go with twice its weight compensated goes 10 mm in 50 ms; a hand
  // that holds a grip still, as it is asked to at the start, stays within a few]
  static constexpr double kTrial = 1, kTrialWay = 0.01;                // s, m
  static constexpr double kFadeBegins = 0.3, kFadeEnds = 0.6;          // m/s: a brisk stroke
  static constexpr double kFast = 0.45, kFastWay = 0.04;               // m/s, m
  static constexpr double kRestSpeed = 0.02, kRest = 0.5, kRamp = 20;  // m/s, s, 1/s

  /// Begins a trial.
  void restart() noexcept;

  /// Returns the share of the force `f_W` (N, in the world) that may be given in this tick;
  /// `others`: a law asks for another force.
  double share(const driver::DeviceState& state, const Eigen::Vector3d& f_W, bool others) noexcept;

  /// Returns how often the force was taken away.
  std::uint64_t withdrawn() const noexcept { return withdrawn_.load(std::memory_order_relaxed); }

 private:
  void judge(double along, double dt, bool others) noexcept;

  Eigen::Vector3d p_last_W_{0, 0, 0};  // m
  Eigen::Vector3d v_W_{0, 0, 0};       // m/s; whatever filter the user's has
  bool begun_ = false;
  bool away_ = false;
  double share_ = 1;
  double trial_ = 0;  // s since it began
  double rest_ = 0;   // s at rest, while it is away
  double way_ = 0;    // m along the force
  std::atomic<std::uint64_t> withdrawn_{0};
};

}  // namespace thimble::session
