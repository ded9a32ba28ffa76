#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <utility>

#include "hand/hand_path.h"
#include "hand/tremor.h"
#include "thimble/driver/export.h"

namespace thimble::device_sim {

/// Where the hand wants the tip over time: along a path that was planned, or led by somebody who
/// drags it; with its tremor; and standing still while it is held. Frame B: base of the arm. All
/// functions but the constructor are Real-time: safe.
class THIMBLE_EXPORT Hand {
 public:
  /// The fastest that a hand goes that is led, m/s. [chosen: a brisk move over a desk]
  static constexpr double kSpeedMax = 0.4;
  /// How quickly a hand that is led comes to where it is led to, 1/s: two time constants are
  /// some 100 ms. [chosen: what a person needs to follow a point by eye]
  static constexpr double kQuickness = 25;

  /// Takes the way, whose time 0 is `begin_ns`. Real-time: never from the servo thread.
  Hand(HandPath path, const Tremor& tremor, std::int64_t begin_ns = 0)
      : path_(std::move(path)), tremor_(tremor), begin_ns_(begin_ns) {}

  /// Finds the wanted point (m) at a time (ns), not before the last one asked for.
  Eigen::Vector3d at(std::int64_t time_ns) noexcept;

  /// Leads the hand to a point (m) from now on, in place of its path. It goes there smoothly,
  /// without overshoot and at most with kSpeedMax. A point that is not finite is ignored.
  void lead(const Eigen::Vector3d& p_BG) noexcept;

  /// Lets the hand stand still, or go on where it stood.
  void hold(bool still) noexcept;

  const HandPath& path() const noexcept { return path_; }  ///< Shows the planned path.

 private:
  std::int64_t own_time_ns(std::int64_t time_ns) const noexcept {
    return (held_ ? held_at_ns_ : time_ns) - held_ns_;
  }
  void approach(double dt) noexcept;

  HandPath path_;
  Tremor tremor_;
  std::int64_t begin_ns_;
  std::int64_t last_ns_ = 0;     // asked for last
  std::int64_t held_ns_ = 0;     // that it has stood still in all, before the present time
  std::int64_t held_at_ns_ = 0;  // since when it stands still, if it does
  bool held_ = false;
  bool led_ = false;
  std::int64_t led_ns_ = 0;  // own time up to which it was led
  Eigen::Vector3d p_BG_{0, 0, 0}, p_BH_{0, 0, 0}, v_BH_{0, 0, 0};
};

}  // namespace thimble::device_sim
