#pragma once

#include <Eigen/Core>
#include <cmath>
#include <numbers>

namespace thimble::device_sim {

/// How a simulated hand turns the stylus: each axis of the gimbal to and fro, a third of a period
/// after the one before. It is a script: no force turns the stylus.
struct GimbalMotion {
  Eigen::Vector3d middle{0, 0, 0};  ///< Angles about which it swings, rad.
  Eigen::Vector3d swing{0, 0, 0};   ///< How far to each side, rad.
  double period = 2;                ///< s. Must be > 0.

  /// Returns the angles of the gimbal at a time (s), rad. Real-time: safe.
  Eigen::Vector3d at(double time) const noexcept {
    Eigen::Vector3d angles = middle;
    for (Eigen::Index i = 0; i < 3; ++i) {
      const double turns = time / period - static_cast<double>(i) / 3;
      angles[i] += swing[i] * std::sin(2 * std::numbers::pi * turns);
    }
    return angles;
  }
};

}  // namespace thimble::device_sim
