#include "mesh/triangle_closest_point.h"

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <limits>

namespace thimble::render {
namespace {

using Eigen::Vector3d;
using Corners = std::array<Vector3d, 3>;

// Finds the closest point for a tip that is not over the triangle. It is on the nearest of the
// edges that the tip is outside of.
void find_on_edges(const Corners& corner, const Vector3d& p_OT,
                   TriangleClosestPoint& closest) noexcept {
  closest.distance_squared = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 3; ++k) {
    if (closest.beside[k] >= 0) continue;
    const std::size_t next = k == 2 ? 0 : k + 1;
    const Vector3d edge = corner[next] - corner[k];
    const double along = edge.dot(p_OT - corner[k]);
    const double length_squared = edge.squaredNorm();
    const bool at_begin = !(along > 0);
    const bool at_end = !at_begin && along >= length_squared;
    const Vector3d p_OP = at_begin ? corner[k]
                          : at_end ? corner[next]
                                   : corner[k] + (along / length_squared) * edge;
    const double distance_squared = (p_OT - p_OP).squaredNorm();
    if (distance_squared >= closest.distance_squared) continue;
    closest.p_OP = p_OP;
    closest.distance_squared = distance_squared;
    closest.place.on = at_begin || at_end ? SurfacePlace::On::kCorner : SurfacePlace::On::kEdge;
    closest.place.k = static_cast<std::uint8_t>(at_end ? next : k);
  }
}

}  // namespace

TriangleClosestPoint closest_on(const ContactMesh& mesh, std::int32_t triangle,
                                const Vector3d& p_OT) noexcept {
  const auto& vertices = mesh.corners(triangle);
  TriangleClosestPoint closest = closest_on(mesh.position(vertices[0]), mesh.position(vertices[1]),
                                            mesh.position(vertices[2]), p_OT);
  closest.place.triangle = triangle;
  return closest;
}

TriangleClosestPoint closest_on(const Vector3d& a, const Vector3d& b, const Vector3d& c,
                                const Vector3d& p_OT) noexcept {
  const Vector3d ab = b - a;
  const Vector3d bc = c - b;
  const Vector3d ca = a - c;
  const Vector3d n = ca.cross(ab);
  const double beside_ab = n.dot(ab.cross(p_OT - a));
  const double beside_bc = n.dot(bc.cross(p_OT - b));
  const double beside_ca = n.dot(ca.cross(p_OT - c));
  TriangleClosestPoint closest;
  closest.normal = n;
  closest.beside = {beside_ab, beside_bc, beside_ca};
  closest.edges_squared = ab.squaredNorm() + bc.squaredNorm() + ca.squaredNorm();

  if (beside_ab >= 0 && beside_bc >= 0 && beside_ca >= 0) {
    // A mean of the corners, not the tip's projection: it stays in the plane of the vertices even
    // if the normal of a thin triangle is wrong.
    const double share = 1 / (beside_ab + beside_bc + beside_ca);
    closest.p_OP = a + (beside_ca * share) * ab - (beside_ab * share) * ca;
    closest.distance_squared = (p_OT - closest.p_OP).squaredNorm();
    return closest;
  }
  find_on_edges({a, b, c}, p_OT, closest);
  return closest;
}

}  // namespace thimble::render
