#include "mesh/file/weld_mesh.h"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace thimble::render {
namespace {

using Eigen::Vector3d;

std::uint64_t hash_of(const Vector3d& p) noexcept {
  std::uint64_t hash = 0;
  for (int i = 0; i < 3; ++i) {
    // Adding +0.0 turns -0.0 into +0.0: both compare equal and so must have the same hash.
    hash ^= std::bit_cast<std::uint64_t>(p[i] + 0.0);
    hash *= 0x9e3779b97f4a7c15u;
    hash ^= hash >> 32;
  }
  return hash;
}

bool same_place(const Vector3d& a, const Vector3d& b) noexcept {
  return a.x() == b.x() && a.y() == b.y() && a.z() == b.z();
}

}  // namespace

TriangleMesh weld_mesh(TriangleMesh mesh) {
  std::vector<Vector3d>& vertices = mesh.vertices;
  // Numbers of the places found, each at its hash or in the next free slot after it.
  const std::size_t slots = std::bit_ceil(vertices.size() + vertices.size() / 2 + 1);
  std::vector<std::int32_t> places(slots, -1);
  std::vector<std::int32_t> new_number(vertices.size());
  std::int32_t count = 0;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Vector3d p = vertices[i];
    std::size_t slot = hash_of(p) & (slots - 1);
    while (places[slot] >= 0 && !same_place(vertices[static_cast<std::size_t>(places[slot])], p)) {
      slot = (slot + 1) & (slots - 1);
    }
    if (places[slot] < 0) {
      // Never behind the vertex being read: at most as many are written as were read.
      vertices[static_cast<std::size_t>(count)] = p;
      places[slot] = count++;
    }
    new_number[i] = places[slot];
  }
  vertices.resize(static_cast<std::size_t>(count));
  for (auto& triangle : mesh.triangles) {
    for (std::int32_t& v : triangle) v = new_number[static_cast<std::size_t>(v)];
  }
  return mesh;
}

}  // namespace thimble::render
