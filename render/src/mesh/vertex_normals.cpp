#include "mesh/vertex_normals.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>

#include "math/elementary.h"

namespace thimble::render {

using Eigen::Vector3d;

double corner_angle(const Vector3d& to_next, const Vector3d& to_last) noexcept {
  return math::atan2(to_next.cross(to_last).norm(), to_next.dot(to_last));
}

std::vector<Vector3d> vertex_normals(const TriangleMesh& mesh) {
  std::vector<Vector3d> normals(mesh.vertices.size(), Vector3d::Zero());
  for (const std::array<std::int32_t, 3>& triangle : mesh.triangles) {
    const auto corner = [&](std::size_t k) -> const Vector3d& {
      return mesh.vertices[static_cast<std::size_t>(triangle[k])];
    };
    const Vector3d normal = (corner(1) - corner(0)).cross(corner(2) - corner(0)).normalized();
    for (std::size_t k = 0; k < 3; ++k) {
      const double angle =
          corner_angle(corner((k + 1) % 3) - corner(k), corner((k + 2) % 3) - corner(k));
      normals[static_cast<std::size_t>(triangle[k])] += angle * normal;
    }
  }
  for (Vector3d& normal : normals) normal.normalize();
  return normals;
}

}  // namespace thimble::render
