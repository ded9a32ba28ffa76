#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "mesh/contact_mesh.h"
#include "mesh/surface_place.h"

namespace thimble::render {

/// The closest point of a triangle to the tip. Frame O of the mesh, m.
struct TriangleClosestPoint {
  Eigen::Vector3d p_OP{0, 0, 0};
  double distance_squared = 0;      ///< Squared distance from the tip, m^2.
  SurfacePlace place;               ///< Face, edge or corner on which it is.
  Eigen::Vector3d normal{0, 0, 0};  ///< Outward normal, as long as twice the triangle's area, m^2.
  /// Distances of the tip from the edges, within the triangle's plane and positive inwards, each
  /// times the edge's length and twice the area, m^4.
  std::array<double, 3> beside{};
  double edges_squared = 0;  ///< Sum of the squared lengths of the edges, m^2.
};

/// Finds the closest point to the tip `p_OT` on a triangle. Reads vertices only through
/// ContactMesh::position, so it follows a surface that moves. If it is a corner, it is
/// bit-identical to the vertex. The point is within rounding of the triangle's plane even where the
/// triangle is too thin for a good normal. Real-time: safe.
TriangleClosestPoint closest_on(const ContactMesh& mesh, std::int32_t triangle,
                                const Eigen::Vector3d& p_OT) noexcept;

/// Finds the same on a triangle of these corners, counter-clockwise from outside; `place` names no
/// triangle. Real-time: safe.
TriangleClosestPoint closest_on(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                const Eigen::Vector3d& c, const Eigen::Vector3d& p_OT) noexcept;

}  // namespace thimble::render
