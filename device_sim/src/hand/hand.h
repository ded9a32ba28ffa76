#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <utility>

#include "hand/hand_path.h"
#include "hand/tremor.h"
#include "thimble/driver/export.h"

namespace thimble::device_sim {

/// Where the hand wants the tip over time. The hand follows a planned path or is led by a user, has
/// a tremor, and can be held still. Frame B: base of the arm. All functions but the constructor are
/// Real-time: safe.
class THIMBLE_EXPORT Hand {
 public:
  /// Max. speed of a hand that is led, m/s. [chosen: a brisk move over a desk]
  static constexpr double kSpeedMax = 0.4;
  /// Approach rate of a hand that is led, 1/s: two time constants are some 100 ms. [chosen: what a
  /// person needs to follow a point by eye]
  static constexpr double kQuickness = 25;

  /// Takes the path, whose time 0 is `begin_ns`. Real-time: never from the servo thread.
  Hand(HandPath path, const Tremor& tremor, std::int64_t begin_ns = 0)
      : path_(std::move(path)), tremor_(tremor), begin_ns_(begin_ns) {}

  /// Returns the wanted point (m) at a time (ns). Precondition: times do not decrease.
  Eigen::Vector3d at(std::int64_t time_ns) noexcept;

  /// Leads the hand to a point (m) from now on, instead of along its path. It moves smoothly,
  /// without overshoot and at most at kSpeedMax. A point that is not finite is ignored.
  void lead(const Eigen::Vector3d& p_BG) noexcept;

  /// Holds the hand still, or lets it continue from where it was held.
  void hold(bool still) noexcept;

  const HandPath& path() const noexcept { return path_; }  ///< Returns the planned path.

 private:
  std::int64_t own_time_ns(std::int64_t time_ns) const noexcept {
    return (held_ ? held_at_ns_ : time_ns) - held_ns_;
  }
  void approach(double dt) noexcept;

  HandPath path_;
  Tremor tremor_;
  std::int64_t begin_ns_;
  std::int64_t last_ns_ = 0;     // time of the last call of `at`
  std::int64_t held_ns_ = 0;     // total time held still, without a hold that still lasts
  std::int64_t held_at_ns_ = 0;  // start of the present hold
  bool held_ = false;
  bool led_ = false;
  std::int64_t led_ns_ = 0;  // own time of the last step of `approach`
  Eigen::Vector3d p_BG_{0, 0, 0}, p_BH_{0, 0, 0}, v_BH_{0, 0, 0};
};

}  // namespace thimble::device_sim
