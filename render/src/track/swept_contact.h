#pragma once

#include <Eigen/Core>

namespace thimble::render {

/// Returns how the triangle a, b, c (counter-clockwise from outside) passes over a point when its
/// corner `a` goes to `a_then` in a straight line: 1 from outside, so that the point comes to lie
/// below it, -1 from below, 0 if it does not. `p_far` is where the ray from the point ends that
/// decides between ties (far_along_x): with the same one everywhere the answers of all triangles
/// around a vertex add up to the change of ContactSearch::inside, exactly. One frame, one unit. 0
/// for NaN. Real-time: safe; some ns unless the point is near.
int swept_over(const Eigen::Vector3d& p, const Eigen::Vector3d& p_far, const Eigen::Vector3d& a,
               const Eigen::Vector3d& b, const Eigen::Vector3d& c,
               const Eigen::Vector3d& a_then) noexcept;

}  // namespace thimble::render
