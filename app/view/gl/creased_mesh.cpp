#include "view/gl/creased_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "mesh/vertex_normals.h"

namespace thimble::view {
namespace {

/// One side of a triangle, with the same name for both sides of an edge.
struct Side {
  std::int32_t low, high;
  std::uint32_t triangle;
  std::uint32_t corner;  // corner at which the side begins
};

/// Joins corners into groups.
class Groups {
 public:
  explicit Groups(std::size_t corners) : parent_(corners) {
    std::iota(parent_.begin(), parent_.end(), 0U);
  }
  std::uint32_t find(std::uint32_t corner) {
    while (parent_[corner] != corner) {
      parent_[corner] = parent_[parent_[corner]];
      corner = parent_[corner];
    }
    return corner;
  }
  void join(std::uint32_t a, std::uint32_t b) { parent_[find(a)] = find(b); }

 private:
  std::vector<std::uint32_t> parent_;
};

std::vector<Side> sides_of(const render::TriangleMesh& mesh) {
  std::vector<Side> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]);
      sides.push_back({low, high, static_cast<std::uint32_t>(t), k});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return a.low != b.low     ? a.low < b.low
           : a.high != b.high ? a.high < b.high
                              : a.triangle < b.triangle;
  });
  return sides;
}

/// Returns the corner of a triangle that is this vertex.
std::uint32_t corner_at(const render::TriangleMesh& mesh, std::uint32_t triangle,
                        std::int32_t vertex) {
  const auto& c = mesh.triangles[triangle];
  return 3 * triangle + (c[0] == vertex ? 0U : c[1] == vertex ? 1U : 2U);
}

/// Returns whether a triangle traverses a side from the lower vertex to the higher.
bool begins_low(const render::TriangleMesh& mesh, const Side& side) {
  return mesh.triangles[side.triangle][side.corner] == side.low;
}

}  // namespace

CreasedMesh crease(const render::TriangleMesh& mesh, double crease_angle, NormalWeights weights) {
  const std::size_t triangles = mesh.triangles.size();
  std::vector<Eigen::Vector3d> faces(triangles);
  const auto at = [&](std::size_t t, std::size_t k) -> const Eigen::Vector3d& {
    return mesh.vertices[static_cast<std::size_t>(mesh.triangles[t][k % 3])];
  };
  for (std::size_t t = 0; t < triangles; ++t) {
    faces[t] = (at(t, 1) - at(t, 0)).cross(at(t, 2) - at(t, 0)).stableNormalized();
  }

  const std::vector<Side> sides = sides_of(mesh);
  Groups groups(3 * triangles);
  std::vector<const Side*> edges;
  bool closed = triangles > 0;
  const double smooth = std::cos(crease_angle);
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t end = i + 1;
    while (end < sides.size() && sides[end].low == sides[i].low && sides[end].high == sides[i].high)
      ++end;
    edges.push_back(&sides[i]);
    closed = closed && end - i == 2 && begins_low(mesh, sides[i]) != begins_low(mesh, sides[i + 1]);
    // If more than two sides meet, it is unknown which belong together.
    if (end - i == 2) {
      const std::uint32_t a = sides[i].triangle;
      const std::uint32_t b = sides[i + 1].triangle;
      if (faces[a].dot(faces[b]) >= smooth) {
        groups.join(corner_at(mesh, a, sides[i].low), corner_at(mesh, b, sides[i].low));
        groups.join(corner_at(mesh, a, sides[i].high), corner_at(mesh, b, sides[i].high));
      }
    }
    i = end;
  }

  CreasedMesh result;
  double volume = 0;
  for (std::size_t t = 0; t < triangles; ++t) volume += at(t, 0).dot(at(t, 1).cross(at(t, 2)));
  result.closed = closed && volume > 0;
  constexpr std::uint32_t kNone = ~0U;
  std::vector<std::uint32_t> number(3 * triangles, kNone);
  std::vector<Eigen::Vector3d> sums;
  result.triangles.resize(triangles);
  for (std::size_t t = 0; t < triangles; ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      std::uint32_t& vertex = number[groups.find(static_cast<std::uint32_t>(3 * t + k))];
      if (vertex == kNone) {
        vertex = static_cast<std::uint32_t>(result.positions.size());
        result.positions.push_back(at(t, k).cast<float>());
        sums.emplace_back(0, 0, 0);
      }
      const double weight =
          weights == NormalWeights::kEqual
              ? 1.0
              : render::corner_angle(at(t, k + 1) - at(t, k), at(t, k + 2) - at(t, k));
      sums[vertex] += weight * faces[t];
      result.triangles[t][k] = vertex;
    }
  }
  for (const Eigen::Vector3d& sum : sums) {
    result.normals.push_back(sum.stableNormalized().cast<float>());
  }
  for (const Side* side : edges) {
    const auto& c = result.triangles[side->triangle];
    result.edges.push_back({c[side->corner], c[(side->corner + 1) % 3]});
  }
  return result;
}

}  // namespace thimble::view
