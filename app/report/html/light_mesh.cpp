#include "report/html/light_mesh.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace thimble::report {
namespace {

// Merges the vertices in each cell of this size (m).
render::TriangleMesh joined(const render::TriangleMesh& mesh, const Eigen::AlignedBox3d& box,
                            double width) {
  std::unordered_map<std::uint64_t, std::int32_t> cells;
  std::vector<std::int32_t> cell_of;
  std::vector<double> count;
  render::TriangleMesh light;
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    const Eigen::Vector3d at = (vertex - box.min()) / width;
    std::uint64_t key = 0;
    for (int k = 0; k < 3; ++k) key = key << 21 | static_cast<std::uint64_t>(at[k]);
    const auto [cell, is_new] = cells.try_emplace(key, static_cast<std::int32_t>(count.size()));
    if (is_new) {
      light.vertices.push_back(Eigen::Vector3d::Zero());
      count.push_back(0);
    }
    const auto number = static_cast<std::size_t>(cell->second);
    light.vertices[number] += vertex;
    ++count[number];
    cell_of.push_back(cell->second);
  }
  for (std::size_t i = 0; i < count.size(); ++i) light.vertices[i] /= count[i];
  for (const auto& [a, b, c] : mesh.triangles) {
    const std::array corners{cell_of[static_cast<std::size_t>(a)],
                             cell_of[static_cast<std::size_t>(b)],
                             cell_of[static_cast<std::size_t>(c)]};
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) continue;
    light.triangles.push_back(corners);
  }
  return light;
}

}  // namespace

render::TriangleMesh light_mesh(const render::TriangleMesh& mesh, std::size_t max_triangles) {
  if (mesh.triangles.size() <= max_triangles) return mesh;
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : mesh.vertices) box.extend(vertex);
  const double longest = box.sizes().maxCoeff();
  // The surface of a cube has two triangles for each of its 6 n^2 cells.
  double cells = std::max(4.0, std::sqrt(static_cast<double>(max_triangles) / 12));
  for (;;) {
    render::TriangleMesh light = joined(mesh, box, longest / cells);
    if (light.triangles.size() <= max_triangles || cells <= 4) return light;
    cells *= 0.8;
  }
}

}  // namespace thimble::report
