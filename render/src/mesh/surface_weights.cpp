#include "mesh/surface_weights.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace thimble::render {
namespace {

using Eigen::Vector3d;

// The least squared cosine between a face and an edge plane's direction. Faces back to back have
// edge planes along the face, whose distances do not determine the place on it.
constexpr double kAlongFace = 1e-6;

}  // namespace

EdgePlaneSides edge_plane_sides(const ContactMesh& mesh, std::int32_t triangle,
                                const Vector3d& p_WT) noexcept {
  const TriangleCell& cell = mesh.cell(triangle);
  const Vector3d p = p_WT - mesh.origin();
  EdgePlaneSides sides;
  for (std::size_t k = 0; k < 3; ++k) {
    const Plane plane = mesh.edge_plane(triangle, k);
    // Edge planes lean by half the angle between the faces: a point of the face at distance h from
    // the edge is at h cos(lean) from the plane.
    const double lean = plane.n.dot(cell.face.n);
    const Vector3d edge = mesh.position(triangle, (k + 1) % 3) - mesh.position(triangle, k);
    const double per_distance = edge.norm() / std::sqrt(std::max(1 - lean * lean, kAlongFace));
    const auto opposite = static_cast<Eigen::Index>((k + 2) % 3);
    sides.value[opposite] = per_distance * plane.distance(p);
    sides.change.row(opposite) = per_distance * plane.n;
  }
  return sides;
}

Vector3d edge_plane_weights(const ContactMesh& mesh, std::int32_t triangle,
                            const Vector3d& p_WT) noexcept {
  const Vector3d weights = edge_plane_sides(mesh, triangle, p_WT).value;
  const double sum = weights.sum();
  if (!(sum > 0)) return Vector3d::Constant(1.0 / 3);
  return weights / sum;
}

Vector3d projected_weights(const ContactMesh& mesh, std::int32_t triangle,
                           const Vector3d& p_WT) noexcept {
  const Vector3d& a = mesh.position(triangle, 0);
  const Vector3d ab = mesh.position(triangle, 1) - a;
  const Vector3d ac = mesh.position(triangle, 2) - a;
  const Vector3d ap = p_WT - a;
  const Vector3d normal = ab.cross(ac);
  const double scale = 1 / normal.squaredNorm();
  const double b = ap.cross(ac).dot(normal) * scale;
  const double c = ab.cross(ap).dot(normal) * scale;
  return {1 - b - c, b, c};
}

}  // namespace thimble::render
