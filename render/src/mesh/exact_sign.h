#pragma once

#include <Eigen/Core>

namespace thimble::render {

// Signs of small polynomials in coordinates, without rounding error. They are computed first in
// plain doubles with a bound on the error. In doubtful cases exact sums of doubles are used
// [Shewchuk].
//
// Exact for coordinates of magnitude 0 or 1e-90 to 1e90; beyond that products leave the range of
// doubles. No heap, no state; at most a few microseconds. Real-time: safe.

/// Returns the sign (-1, 0, +1) of ((b - a) x (c - a)) . (d - a): +1 if `d` is on the side from
/// which a, b, c are counter-clockwise.
int orientation(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                const Eigen::Vector3d& d) noexcept;

/// Returns the sign of component `axis` (0 to 2) of (b - a) x (d - c).
int cross_sign(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
               const Eigen::Vector3d& d, int axis) noexcept;

}  // namespace thimble::render
