#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "mesh/contact_mesh.h"
#include "thimble/driver/export.h"

namespace thimble::render {

// Weights of a triangle's corners describe the place of a tip on it. They sum to 1. Weight k is 0
// on the side opposite corner k, and all are at least 0 in the triangle.

/// Distances of a tip from the edge planes of a triangle, as areas; edge_plane_weights are their
/// shares.
struct EdgePlaneSides {
  Eigen::Vector3d value{0, 0, 0};                    ///< Twice an area, m^2, opposite of corner k.
  Eigen::Matrix3d change = Eigen::Matrix3d::Zero();  ///< Row k: its gradient, m in W.
};

/// Returns the areas for a tip at `p_WT` (W, m). Real-time: safe.
EdgePlaneSides edge_plane_sides(const ContactMesh& mesh, std::int32_t triangle,
                                const Eigen::Vector3d& p_WT) noexcept;

/// Returns the weights of a tip (W, m) from its distances to the edge planes of a triangle. A
/// weight vanishes exactly on the edge plane that both neighbours share [BP 4b]. On the surface
/// they are the barycentric weights. Negative beyond an edge plane; all 1/3 where three planes
/// leave no room. Real-time: safe.
Eigen::Vector3d edge_plane_weights(const ContactMesh& mesh, std::int32_t triangle,
                                   const Eigen::Vector3d& p_WT) noexcept;

/// Returns the weights of the projection of a tip (W, m) along the face's normal [BP 4a]. Negative
/// if the projection is outside the triangle. Real-time: safe.
THIMBLE_EXPORT Eigen::Vector3d projected_weights(const ContactMesh& mesh, std::int32_t triangle,
                                                 const Eigen::Vector3d& p_WT) noexcept;

/// Limits weights to the triangle: negative ones become 0, the others are scaled to sum 1.
/// Real-time: safe.
inline Eigen::Vector3d within_triangle(const Eigen::Vector3d& weights) noexcept {
  if (weights.minCoeff() >= 0) return weights;
  const Eigen::Vector3d positive = weights.cwiseMax(0);
  return positive / positive.sum();
}

/// Returns the point of a triangle with these weights, m in W. Real-time: safe.
inline Eigen::Vector3d point_at(const ContactMesh& mesh, std::int32_t triangle,
                                const Eigen::Vector3d& weights) noexcept {
  const Eigen::Vector3d& a = mesh.position(triangle, 0);
  return a + weights[1] * (mesh.position(triangle, 1) - a) +
         weights[2] * (mesh.position(triangle, 2) - a);
}

}  // namespace thimble::render
