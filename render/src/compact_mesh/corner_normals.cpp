#include "compact_mesh/corner_normals.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "compact_mesh/corner_angles.h"
#include "compact_mesh/unfinished_triangle.h"
#include "math/elementary.h"
#include "mesh/parallel_split.h"
#include "mesh/smooth_normals.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

using namespace unfinished;

std::size_t index(std::int32_t i) noexcept {
  return static_cast<std::size_t>(i);
}

std::size_t corner_of(const std::array<std::int32_t, 3>& corners, std::int32_t vertex) noexcept {
  return corners[0] == vertex ? 0 : corners[1] == vertex ? 1 : 2;
}

// Calls `visit` for a triangle and for all that are reached from it around one of its vertices
// without crossing a crease. Goes first in one direction, then in the other, and calls `visit` once
// for each.
template <class Visit>
void visit_group(std::span<const PackedTriangle> packed, std::int32_t vertex, std::int32_t first,
                 const Visit& visit) {
  visit(first);
  for (const std::size_t side : {std::size_t{0}, std::size_t{2}}) {
    std::int32_t t = first;
    for (;;) {
      const std::size_t edge = (corner_of(corners(packed[index(t)]), vertex) + side) % 3;
      if (packed[index(t)].crease(edge)) break;
      t = packed[index(t)].neighbours[edge];
      // Around the whole vertex over a single crease or none: all have been visited.
      if (t == first) return;
      visit(t);
    }
  }
}

// Sums the normals of a group's faces, each weighted by its angle at the vertex.
Vector3d fan_normal(std::span<const PackedTriangle> packed, std::int32_t vertex,
                    std::int32_t first) {
  Vector3d sum{0, 0, 0};
  visit_group(packed, vertex, first, [&](std::int32_t t) {
    const PackedTriangle& triangle = packed[index(t)];
    const std::size_t k = corner_of(corners(triangle), vertex);
    sum += static_cast<double>(angle(triangle, k)) * face_normal(triangle);
  });
  return sum;
}

// At a vertex with more triangles than this, normals are computed once per smooth group: once per
// triangle would cost the square of their number.
constexpr std::size_t kHub = 64;

// Work memory of one thread for vertices with many triangles.
struct HubWork {
  std::vector<bool> done;  // per triangle; empty or false everywhere between two vertices
  std::vector<std::pair<std::int32_t, std::uint32_t>> normals;  // triangle, packed normal
};

// Assigns the normals at a vertex with many triangles, some of whose edges are creases. They are
// written last, because they replace the angles that the sums need.
void assign_hub(std::span<const HalfEdges::Side> fan, std::int32_t vertex, HubWork& work,
                std::span<PackedTriangle> packed) {
  work.done.resize(packed.size(), false);
  work.normals.clear();
  for (const auto& side : fan) {
    if (work.done[index(side.triangle)]) continue;
    const Vector3d sum = fan_normal(packed, vertex, side.triangle);
    visit_group(packed, vertex, side.triangle, [&](std::int32_t t) {
      const Vector3d own = sum.norm() > 0 ? sum : face_normal(packed[index(t)]);
      work.normals.emplace_back(t, pack_normal(own));
      work.done[index(t)] = true;
    });
  }
  for (const auto& [t, normal] : work.normals) {
    PackedTriangle& triangle = packed[index(t)];
    triangle.normals[corner_of(corners(triangle), vertex)] = normal;
  }
  for (const auto& side : fan) work.done[index(side.triangle)] = false;
}

// Returns false if the triangle has no area.
bool measure_face(const std::vector<Vector3d>& vertices, PackedTriangle& triangle) noexcept {
  const Vector3d& a = vertices[index(corners(triangle)[0])];
  const Vector3d ab = vertices[index(corners(triangle)[1])] - a;
  const Vector3d ac = vertices[index(corners(triangle)[2])] - a;
  const Vector3d area = ab.cross(ac);
  const double twice_area = area.stableNorm();
  if (!(twice_area > 0)) return false;
  set_face_normal(triangle, area / twice_area);
  set_angles(triangle, corner_angles(ab, ac, twice_area));
  return true;
}

void find_creases(const std::vector<Vector3d>& vertices, double crease_angle,
                  std::span<PackedTriangle> packed) {
  const double crease_cosine = math::cos(crease_angle);
  const double concave_cosine = math::cos(std::min(crease_angle, kConcaveCreaseAngle));
  parallel_split(packed.size(), [&](std::size_t first, std::size_t end) noexcept {
    for (std::size_t t = first; t < end; ++t) {
      const Vector3d normal = face_normal(packed[t]);
      const std::array<std::int32_t, 3>& own = corners(packed[t]);
      std::uint32_t flags = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const PackedTriangle& behind = packed[index(packed[t].neighbours[k])];
        const double cosine = normal.dot(face_normal(behind));
        // The corner behind the edge is above this face.
        const auto is_concave = [&] {
          const Vector3d& begin = vertices[index(own[k])];
          for (const std::int32_t v : corners(behind)) {
            if (v == own[k] || v == own[(k + 1) % 3]) continue;
            return normal.dot(vertices[index(v)] - begin) > 0;
          }
          return false;
        };
        const bool sharp = !(cosine >= crease_cosine) || (cosine < concave_cosine && is_concave());
        if (sharp) flags |= 1u << k;
      }
      packed[t].flags |= flags;
    }
  });
}

// Assigns the normals of all corners at a vertex.
void assign_vertex(const HalfEdges& half_edges, std::int32_t vertex, HubWork& work,
                   std::span<PackedTriangle> packed) {
  const auto fan = half_edges.around(vertex);
  bool smooth = true;
  Vector3d sum{0, 0, 0};
  for (const auto& side : fan) {
    const PackedTriangle& triangle = packed[index(side.triangle)];
    const std::size_t k = corner_of(corners(triangle), vertex);
    smooth &= !triangle.crease(k);
    sum += static_cast<double>(angle(triangle, k)) * face_normal(triangle);
  }
  if (!smooth && fan.size() > kHub) return assign_hub(fan, vertex, work, packed);
  const std::uint32_t code = smooth && sum.norm() > 0 ? pack_normal(sum) : 0;
  std::array<std::uint32_t, kHub> codes;
  for (std::size_t i = 0; !smooth && i < fan.size(); ++i) {
    const std::int32_t t = fan[i].triangle;
    const Vector3d own = fan_normal(packed, vertex, t);
    codes[i] = pack_normal(own.norm() > 0 ? own : face_normal(packed[index(t)]));
  }
  // Written last, because they replace the angles that the sums need.
  for (std::size_t i = 0; i < fan.size(); ++i) {
    PackedTriangle& triangle = packed[index(fan[i].triangle)];
    std::uint32_t& normal = triangle.normals[corner_of(corners(triangle), vertex)];
    if (!smooth) {
      normal = codes[i];
    } else {
      normal = code != 0 ? code : pack_normal(sum.norm() > 0 ? sum : face_normal(triangle));
    }
  }
}

}  // namespace

std::ptrdiff_t assign_corner_normals(const std::vector<Vector3d>& vertices,
                                     const HalfEdges& half_edges, double crease_angle,
                                     std::span<PackedTriangle> packed) {
  std::atomic<std::size_t> flat = packed.size();
  parallel_split(packed.size(), [&](std::size_t begin, std::size_t end) noexcept {
    for (std::size_t t = begin; t < end; ++t) {
      if (measure_face(vertices, packed[t])) continue;
      // The first flat triangle is reported.
      std::size_t first = flat;
      while (t < first && !flat.compare_exchange_weak(first, t)) continue;
      return;
    }
  });
  if (flat < packed.size()) return static_cast<std::ptrdiff_t>(flat.load());
  find_creases(vertices, crease_angle, packed);
  parallel_split(vertices.size(), [&](std::size_t begin, std::size_t end) {
    HubWork work;
    for (std::size_t v = begin; v < end; ++v) {
      assign_vertex(half_edges, static_cast<std::int32_t>(v), work, packed);
    }
  });
  return -1;
}

}  // namespace thimble::render
