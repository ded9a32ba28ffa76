#include "mesh/file/weld_mesh.h"

#include <bit>
#include <cstddef>
#include <unordered_map>

namespace thimble::render {
namespace {

using Eigen::Vector3d;

struct PlaceHash {
  std::size_t operator()(const Vector3d& p) const noexcept {
    std::uint64_t hash = 0;
    for (int i = 0; i < 3; ++i) {
      // Adding +0.0 turns -0.0 into +0.0, which compares equal and so must hash alike.
      hash ^= std::bit_cast<std::uint64_t>(p[i] + 0.0);
      hash *= 0x9e3779b97f4a7c15u;
      hash ^= hash >> 32;
    }
    return static_cast<std::size_t>(hash);
  }
};

struct SamePlace {
  bool operator()(const Vector3d& a, const Vector3d& b) const noexcept {
    return a.x() == b.x() && a.y() == b.y() && a.z() == b.z();
  }
};

}  // namespace

TriangleMesh weld_mesh(const TriangleMesh& mesh) {
  TriangleMesh welded;
  welded.vertices.reserve(mesh.vertices.size());
  std::unordered_map<Vector3d, std::int32_t, PlaceHash, SamePlace> places;
  places.reserve(mesh.vertices.size());
  std::vector<std::int32_t> new_number(mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const auto next = static_cast<std::int32_t>(welded.vertices.size());
    const auto [place, is_new] = places.try_emplace(mesh.vertices[i], next);
    if (is_new) welded.vertices.push_back(mesh.vertices[i]);
    new_number[i] = place->second;
  }
  welded.triangles.reserve(mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles) {
    welded.triangles.push_back({new_number[static_cast<std::size_t>(a)],
                                new_number[static_cast<std::size_t>(b)],
                                new_number[static_cast<std::size_t>(c)]});
  }
  return welded;
}

}  // namespace thimble::render
