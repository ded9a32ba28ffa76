#include "share/shared_edge_split.h"

#include <algorithm>
#include <cstddef>

namespace thimble::session {

bool split_edge(render::TriangleMesh& mesh, std::uint32_t kept, std::uint32_t lost,
                std::array<std::uint32_t, 2> triangles) {
  const auto has = [&](std::uint32_t triangle, std::uint32_t vertex) {
    const auto& corners = mesh.triangles[triangle];
    return std::find(corners.begin(), corners.end(), static_cast<std::int32_t>(vertex)) !=
           corners.end();
  };
  if (kept == lost || kept >= mesh.vertices.size() || lost >= mesh.vertices.size() ||
      triangles[0] == triangles[1]) {
    return false;
  }
  for (const std::uint32_t triangle : triangles) {
    if (triangle >= mesh.triangles.size() || !has(triangle, kept) || !has(triangle, lost)) {
      return false;
    }
  }
  const auto middle = static_cast<std::int32_t>(mesh.vertices.size());
  mesh.vertices.push_back((mesh.vertices[kept] + mesh.vertices[lost]) / 2);
  for (const std::uint32_t triangle : triangles) {
    auto other = mesh.triangles[triangle];
    std::replace(other.begin(), other.end(), static_cast<std::int32_t>(kept), middle);
    auto& corners = mesh.triangles[triangle];
    std::replace(corners.begin(), corners.end(), static_cast<std::int32_t>(lost), middle);
    mesh.triangles.push_back(other);
  }
  return true;
}

}  // namespace thimble::session
