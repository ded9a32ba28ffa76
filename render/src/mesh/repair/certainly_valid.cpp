#include "mesh/repair/certainly_valid.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <future>
#include <vector>

#include "thimble/render/mesh/check_mesh.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

// Below, a thread costs more than it saves [measured: 10 us against 20 ns per triangle].
constexpr std::size_t kAsyncTrianglesMin = 20000;

const Vector3d& corner(const TriangleMesh& mesh, std::size_t t, std::size_t k) noexcept {
  return mesh.vertices[static_cast<std::size_t>(mesh.triangles[t][k])];
}

// Empty if a vertex is not finite.
Eigen::AlignedBox3d box_of(const TriangleMesh& mesh) noexcept {
  Eigen::AlignedBox3d box;
  for (const Vector3d& p : mesh.vertices) {
    if (!p.allFinite()) return {};
    box.extend(p);
  }
  return box;
}

// Returns whether each triangle clearly has an area, and all of them enclose matter, not a cavity.
bool holds_matter(const TriangleMesh& mesh, const Eigen::AlignedBox3d& box) noexcept {
  // Sizes for which no square of an area overflows or underflows.
  constexpr double kSizeMax = 1e60, kSquareMin = 1e-140;
  // Roundings of the norms in check_mesh are 1e-15 of them.
  constexpr double kByFar = 1.001;
  const double reach = box.diagonal().norm() / 2;
  if (!(reach < kSizeMax)) return false;
  const Vector3d middle = box.center();
  double volume = 0, sizes = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vector3d &a = corner(mesh, t, 0), &b = corner(mesh, t, 1), &c = corner(mesh, t, 2);
    const double area = (b - a).cross(c - a).squaredNorm();
    const double longest =
        std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
    const bool wide =
        longest > kSquareMin && area > kByFar * kFlatness * kFlatness * longest * longest;
    if (!wide) return false;
    const double part = (a - middle).dot((b - middle).cross(c - middle));
    volume += part;
    sizes += std::abs(part);
  }
  // A part is a sum of six products of three factors up to `reach`, each wrong by a few 2^-53. A
  // sum is wrong by 2^-53 of each partial sum. Twice all that, because the volume whose sign
  // check_mesh uses is wrong by as much.
  const auto count = static_cast<double>(mesh.triangles.size());
  return volume > count * (0x1p-46 * reach * reach * reach + 0x1p-51 * sizes);
}

// Returns whether the triangles at each vertex are one fan, and none is back to back with another
// on the same three vertices.
bool has_single_fans(const TriangleMesh& mesh, const Adjacency& neighbours) {
  std::vector<std::uint32_t> around(mesh.vertices.size(), 0);
  for (const auto& corners : mesh.triangles) {
    for (const std::int32_t v : corners) ++around[static_cast<std::size_t>(v)];
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& behind = neighbours[t];
    if (behind[0] == behind[1] && behind[1] == behind[2]) return false;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t vertex = mesh.triangles[t][k];
      std::uint32_t& expected = around[static_cast<std::size_t>(vertex)];
      if (expected == 0) continue;
      std::uint32_t count = 0;
      std::size_t at = t, edge = k;
      do {
        at = static_cast<std::size_t>(neighbours[at][edge]);
        const auto& corners = mesh.triangles[at];
        edge = corners[0] == vertex ? 0 : corners[1] == vertex ? 1 : 2;
        ++count;
      } while (at != t && count <= expected);
      if (count != expected) return false;
      expected = 0;
    }
  }
  return true;
}

bool hangs_together(const Adjacency& neighbours) {
  std::vector<std::uint8_t> reached(neighbours.size(), 0);
  std::vector<std::int32_t> waiting{0};
  reached[0] = 1;
  std::size_t count = 1;
  while (!waiting.empty()) {
    const std::int32_t t = waiting.back();
    waiting.pop_back();
    for (const std::int32_t next : neighbours[static_cast<std::size_t>(t)]) {
      std::uint8_t& seen = reached[static_cast<std::size_t>(next)];
      if (seen != 0) continue;
      seen = 1;
      ++count;
      waiting.push_back(next);
    }
  }
  return count == neighbours.size();
}

}  // namespace

bool certainly_valid(const TriangleMesh& mesh, const Adjacency& neighbours) {
  if (mesh.triangles.empty()) return false;
  const Eigen::AlignedBox3d box = box_of(mesh);
  if (box.isEmpty()) return false;
  auto matter = std::async(mesh.triangles.size() >= kAsyncTrianglesMin
                               ? std::launch::async | std::launch::deferred
                               : std::launch::deferred,
                           [&mesh, &box] { return holds_matter(mesh, box); });
  return hangs_together(neighbours) && has_single_fans(mesh, neighbours) && matter.get();
}

bool certainly_valid(const TriangleMesh& mesh) {
  const auto neighbours = adjacency_if_closed(mesh);
  return neighbours && certainly_valid(mesh, *neighbours);
}

}  // namespace thimble::render
