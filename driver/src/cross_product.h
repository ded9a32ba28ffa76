#pragma once

#include <Eigen/Core>

namespace thimble::driver {

/// Returns the cross product of two vectors of a plane: positive if b is counter-clockwise of a.
/// Real-time: safe.
inline double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) noexcept {
  return a.x() * b.y() - a.y() * b.x();
}

}  // namespace thimble::driver
