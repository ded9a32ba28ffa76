#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace thimble::compat::dhd {

/// Bounds of a motion along a path: m/s^2, m/s, m/s^3.
struct PathBounds {
  double acceleration = 1;  ///< Maximum acceleration.
  double speed = 0.1;       ///< Maximum speed [chosen: a hand on the tip can follow it].
  double jerk = 20;         ///< Maximum jerk.
};

/// Returns whether all bounds are finite and positive.
inline bool is_valid(const PathBounds& bounds) noexcept {
  for (const double value : {bounds.acceleration, bounds.speed, bounds.jerk}) {
    if (!(std::isfinite(value) && value > 0)) return false;
  }
  return true;
}

/// A motion from rest to rest along a straight line, by the polynomial of fifth degree with zero
/// speed and acceleration at both ends (minimum jerk). Its duration is the shortest within the
/// bounds. Real-time: safe.
class StraightPath {
 public:
  StraightPath() = default;
  /// A path from `from` to `to`, both m.
  StraightPath(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
               const PathBounds& bounds) noexcept
      : from_(from), to_(to) {
    const double length = (to - from).norm();
    // Maxima of the polynomial's derivatives for unit length and duration: 15/8, 10/sqrt(3), 60.
    duration_ = std::max({1.875 * length / bounds.speed,
                          std::sqrt(10 / std::sqrt(3.0) * length / bounds.acceleration),
                          std::cbrt(60 * length / bounds.jerk)});
  }

  /// Returns its duration, s.
  double duration() const noexcept { return duration_; }
  /// Returns the point at `time` (s), m.
  Eigen::Vector3d at(double time) const noexcept {
    if (!(time < duration_)) return to_;
    const double s = std::max(time, 0.0) / duration_;
    return from_ + s * s * s * (10 + s * (6 * s - 15)) * (to_ - from_);
  }
  /// Returns the end point, m.
  const Eigen::Vector3d& end() const noexcept { return to_; }

 private:
  Eigen::Vector3d from_{0, 0, 0}, to_{0, 0, 0};
  double duration_ = 0;
};

}  // namespace thimble::compat::dhd
