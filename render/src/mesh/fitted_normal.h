#pragma once

#include <Eigen/Core>
#include <span>

namespace thimble::render {

/// Returns the normal of a smooth surface at a vertex from points around it. It is that of the
/// paraboloid z = a u + b v + c u^2 + d u v + e v^2 through the vertex that fits the points best.
/// Near points have the largest weights [Cazals]. Second order on triangles of any shape, where
/// every weighted mean of face normals is first order. `about` is a first guess (unit) that defines
/// the outside. It is returned if the points are fewer than six, do not determine the paraboloid,
/// or give a normal that leans away from it. Real-time: safe; some 100 instructions per point.
Eigen::Vector3d fitted_normal(const Eigen::Vector3d& vertex,
                              std::span<const Eigen::Vector3d> around,
                              const Eigen::Vector3d& about) noexcept;

}  // namespace thimble::render
