#include "apply_patch.h"

#include <cstddef>
#include <vector>

namespace thimble::session {

render::TriangleMesh apply_patch(const render::TriangleMesh& mesh, const scene::MeshPlace& place,
                                 const render::BodyPatch& patch) {
  std::vector<bool> left_out(mesh.triangles.size(), false);
  for (std::size_t i = 0; i < patch.triangle_count; ++i) {
    left_out[place.triangle + static_cast<std::size_t>(patch.source[i])] = true;
  }
  render::TriangleMesh result;
  result.vertices = mesh.vertices;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!left_out[t]) result.triangles.push_back(mesh.triangles[t]);
  }
  // Vertices of the mesh stay its own, so that patch and mesh share those between them.
  std::vector<std::int32_t> number;
  for (std::size_t i = 0; i < patch.point_count; ++i) {
    const render::BodyPatch::Point& point = patch.points[i];
    const Eigen::Vector3d p(point.p[0], point.p[1], point.p[2]);
    if (point.vertex >= 0) {
      const std::size_t vertex = place.vertex + static_cast<std::size_t>(point.vertex);
      result.vertices[vertex] = p;
      number.push_back(static_cast<std::int32_t>(vertex));
    } else {
      number.push_back(static_cast<std::int32_t>(result.vertices.size()));
      result.vertices.push_back(p);
    }
  }
  for (std::size_t i = 0; i < patch.triangle_count; ++i) {
    const auto& [a, b, c] = patch.triangles[i];
    result.triangles.push_back({number[a], number[b], number[c]});
  }
  return result;
}

}  // namespace thimble::session
