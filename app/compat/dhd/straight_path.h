#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace thimble::compat::dhd {

/// Bounds of a motion along a path: m/s^2, m/s, m/s^3.
struct PathBounds {
  double acceleration = 1;  ///< Largest acceleration.
  double speed = 0.1;       ///< Largest speed [chosen: a hand on the tip follows it].
  double jerk = 20;         ///< Largest jerk.
};

/// A motion from rest to rest along a straight line: the polynomial of fifth degree whose speed and
/// acceleration are zero at both ends (the motion of least jerk), as quick as its bounds allow.
/// Real-time: safe.
class StraightPath {
 public:
  StraightPath() = default;
  /// Begins at `from` and ends at `to`, both m.
  StraightPath(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
               const PathBounds& bounds) noexcept
      : from_(from), to_(to) {
    const double length = (to - from).norm();
    // The polynomial's largest values over a length and a time of 1: 15/8, 10/sqrt(3), 60.
    duration_ = std::max({1.875 * length / bounds.speed,
                          std::sqrt(10 / std::sqrt(3.0) * length / bounds.acceleration),
                          std::cbrt(60 * length / bounds.jerk)});
  }

  /// Returns how long it takes, s.
  double duration() const noexcept { return duration_; }
  /// Returns where it is after `time` (s), m.
  Eigen::Vector3d at(double time) const noexcept {
    if (!(time < duration_)) return to_;
    const double s = std::max(time, 0.0) / duration_;
    return from_ + s * s * s * (10 + s * (6 * s - 15)) * (to_ - from_);
  }
  /// Returns where it ends, m.
  const Eigen::Vector3d& end() const noexcept { return to_; }

 private:
  Eigen::Vector3d from_{0, 0, 0}, to_{0, 0, 0};
  double duration_ = 0;
};

}  // namespace thimble::compat::dhd
