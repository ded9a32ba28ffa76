#pragma once

#include <Eigen/Core>

namespace thimble::render {

/// Returns how the triangle a, b, c (counter-clockwise from outside) passes over a point when its
/// corner `a` moves to `a_then` in a straight line: 1 from outside, so that the point is then below
/// it, -1 from below, 0 if it does not pass. `p_far` is the end of the ray from the point that
/// breaks ties (far_along_x). With the same ray for all triangles around a vertex, the results add
/// up exactly to the change of ContactSearch::inside. One frame, one unit. 0 for NaN. Real-time:
/// safe; some ns unless the point is near.
int swept_over(const Eigen::Vector3d& p, const Eigen::Vector3d& p_far, const Eigen::Vector3d& a,
               const Eigen::Vector3d& b, const Eigen::Vector3d& c,
               const Eigen::Vector3d& a_then) noexcept;

}  // namespace thimble::render
