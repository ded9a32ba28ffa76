#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "mesh/contact_mesh.h"
#include "mesh/surface_place.h"

namespace thimble::render {

/// The point of a triangle nearest to the tip. Frame O of the mesh, m.
struct Foot {
  Eigen::Vector3d p_OP{0, 0, 0};
  double distance_squared = 0;      ///< From the tip, m^2.
  SurfacePlace place;               ///< What of the triangle it is.
  Eigen::Vector3d normal{0, 0, 0};  ///< Outwards, as long as twice the triangle's area, m^2.
  /// Distances of the tip from the edges, within the triangle's plane and inwards, each times the
  /// edge's length and twice the area, m^4.
  std::array<double, 3> beside{};
  double edges_squared = 0;  ///< Sum of the squared lengths of the edges, m^2.
};

/// Finds the foot of the tip `p_OT` on a triangle. Reads vertices through ContactMesh::position
/// only, so it follows a surface that moves. A corner is met to the bit; the foot lies within
/// rounding of the triangle's own vertices even where the triangle is too thin for a good normal.
/// Real-time: safe.
Foot foot_on(const ContactMesh& mesh, std::int32_t triangle, const Eigen::Vector3d& p_OT) noexcept;

/// Finds the same on a triangle of these corners, counter-clockwise from outside; `place` names no
/// triangle. Real-time: safe.
Foot foot_on(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
             const Eigen::Vector3d& p_OT) noexcept;

}  // namespace thimble::render
