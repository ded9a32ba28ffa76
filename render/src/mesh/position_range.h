#pragma once

#include <Eigen/Core>
#include <cmath>

namespace thimble::render {

/// The largest valid coordinate of a query point, m: products of three stay far from overflow, and
/// no arm reaches there.
inline constexpr double kPositionMax = 1e15;

/// Returns whether a point is a valid query: no coordinate is NaN or beyond `kPositionMax`.
/// Real-time: safe.
inline bool within_range(const Eigen::Vector3d& p_W) noexcept {
  return std::abs(p_W.x()) <= kPositionMax && std::abs(p_W.y()) <= kPositionMax &&
         std::abs(p_W.z()) <= kPositionMax;
}

}  // namespace thimble::render
