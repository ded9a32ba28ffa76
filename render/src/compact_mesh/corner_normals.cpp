#include "compact_mesh/corner_normals.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <span>
#include <vector>

#include "compact_mesh/corner_angles.h"
#include "math/elementary.h"
#include "mesh/parallel_split.h"
#include "mesh/smooth_normals.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

struct Faces {
  std::vector<Vector3d> normals;
  std::vector<std::array<float, 3>> angles;  // at the corners, rad
};

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
void visit_group(const std::vector<std::array<std::int32_t, 3>>& triangles,
                 std::span<const PackedTriangle> packed, std::int32_t vertex, std::int32_t first,
                 const Visit& visit) {
  visit(first);
  for (const std::size_t side : {std::size_t{0}, std::size_t{2}}) {
    std::int32_t t = first;
    for (;;) {
      const std::size_t edge = (corner_of(triangles[index(t)], vertex) + side) % 3;
      if (packed[index(t)].crease(edge)) break;
      t = packed[index(t)].neighbours[edge];
      // Around the whole vertex over a single crease or none: all have been visited.
      if (t == first) return;
      visit(t);
    }
  }
}

// Sums the normals of a group's faces, each weighted by its angle at the vertex.
Vector3d fan_normal(const std::vector<std::array<std::int32_t, 3>>& triangles,
                    std::span<const PackedTriangle> packed, const Faces& faces, std::int32_t vertex,
                    std::int32_t first) {
  Vector3d sum{0, 0, 0};
  visit_group(triangles, packed, vertex, first, [&](std::int32_t t) {
    const std::size_t k = corner_of(triangles[index(t)], vertex);
    sum += static_cast<double>(faces.angles[index(t)][k]) * faces.normals[index(t)];
  });
  return sum;
}

// At a vertex with more triangles than this, normals are computed once per smooth group: once per
// triangle would cost the square of their number.
constexpr std::size_t kHub = 64;

// Gives the corners of a smooth group, the triangles reached from `first` without crossing a
// crease, one normal. Adds them to `done`.
void assign_group(const std::vector<std::array<std::int32_t, 3>>& triangles, const Faces& faces,
                  std::int32_t vertex, std::int32_t first, std::vector<bool>& done,
                  std::span<PackedTriangle> packed) {
  const Vector3d sum = fan_normal(triangles, packed, faces, vertex, first);
  visit_group(triangles, packed, vertex, first, [&](std::int32_t t) {
    const Vector3d& own = sum.norm() > 0 ? sum : faces.normals[index(t)];
    packed[index(t)].normals[corner_of(triangles[index(t)], vertex)] = pack_normal(own);
    done[index(t)] = true;
  });
}

// Returns false if the triangle has no area.
bool measure_face(const std::vector<Vector3d>& vertices,
                  const std::vector<std::array<std::int32_t, 3>>& triangles, std::size_t t,
                  Faces& faces) noexcept {
  const Vector3d& a = vertices[index(triangles[t][0])];
  const Vector3d ab = vertices[index(triangles[t][1])] - a;
  const Vector3d ac = vertices[index(triangles[t][2])] - a;
  const Vector3d area = ab.cross(ac);
  const double twice_area = area.stableNorm();
  if (!(twice_area > 0)) return false;
  faces.normals[t] = area / twice_area;
  faces.angles[t] = corner_angles(ab, ac, twice_area);
  return true;
}

void find_creases(const std::vector<Vector3d>& vertices,
                  const std::vector<std::array<std::int32_t, 3>>& triangles, const Faces& faces,
                  double crease_angle, std::span<PackedTriangle> packed) {
  const double crease_cosine = math::cos(crease_angle);
  const double concave_cosine = math::cos(std::min(crease_angle, kConcaveCreaseAngle));
  parallel_split(triangles.size(), [&](std::size_t first, std::size_t end) noexcept {
    for (std::size_t t = first; t < end; ++t) {
      std::uint32_t flags = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t behind = index(packed[t].neighbours[k]);
        const Vector3d& other = faces.normals[behind];
        const double cosine = faces.normals[t].dot(other);
        // The corner behind the edge is above this face.
        const auto is_concave = [&] {
          const Vector3d& begin = vertices[index(triangles[t][k])];
          for (const std::int32_t v : triangles[behind]) {
            if (v == triangles[t][k] || v == triangles[t][(k + 1) % 3]) continue;
            return faces.normals[t].dot(vertices[index(v)] - begin) > 0;
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

// Assigns the normals of all corners at a vertex. `done` is empty or false everywhere, and stays
// so.
void assign_vertex(const std::vector<std::array<std::int32_t, 3>>& triangles,
                   const HalfEdges& half_edges, const Faces& faces, std::int32_t vertex,
                   std::vector<bool>& done, std::span<PackedTriangle> packed) {
  const auto fan = half_edges.around(vertex);
  bool smooth = true;
  Vector3d sum{0, 0, 0};
  for (const auto& side : fan) {
    const std::size_t t = index(side.triangle);
    const std::size_t k = corner_of(triangles[t], vertex);
    smooth &= !packed[t].crease(k);
    sum += static_cast<double>(faces.angles[t][k]) * faces.normals[t];
  }
  if (!smooth && fan.size() > kHub) {
    done.resize(triangles.size(), false);
    for (const auto& side : fan) {
      if (done[index(side.triangle)]) continue;
      assign_group(triangles, faces, vertex, side.triangle, done, packed);
    }
    for (const auto& side : fan) done[index(side.triangle)] = false;
    return;
  }
  const std::uint32_t code = smooth && sum.norm() > 0 ? pack_normal(sum) : 0;
  for (const auto& side : fan) {
    const std::size_t t = index(side.triangle);
    Vector3d own = sum;
    if (!smooth) own = fan_normal(triangles, packed, faces, vertex, side.triangle);
    if (!(own.norm() > 0)) own = faces.normals[t];
    packed[t].normals[corner_of(triangles[t], vertex)] = code != 0 ? code : pack_normal(own);
  }
}

}  // namespace

std::ptrdiff_t assign_corner_normals(const std::vector<Vector3d>& vertices,
                                     const std::vector<std::array<std::int32_t, 3>>& triangles,
                                     const HalfEdges& half_edges, double crease_angle,
                                     std::span<PackedTriangle> packed) {
  Faces faces;
  faces.normals.resize(triangles.size());
  faces.angles.resize(triangles.size());
  std::atomic<std::size_t> flat = triangles.size();
  parallel_split(triangles.size(), [&](std::size_t begin, std::size_t end) noexcept {
    for (std::size_t t = begin; t < end; ++t) {
      if (measure_face(vertices, triangles, t, faces)) continue;
      // The first flat triangle is reported.
      std::size_t first = flat;
      while (t < first && !flat.compare_exchange_weak(first, t)) continue;
      return;
    }
  });
  if (flat < triangles.size()) return static_cast<std::ptrdiff_t>(flat.load());
  find_creases(vertices, triangles, faces, crease_angle, packed);
  parallel_split(vertices.size(), [&](std::size_t begin, std::size_t end) {
    std::vector<bool> done;
    for (std::size_t v = begin; v < end; ++v) {
      assign_vertex(triangles, half_edges, faces, static_cast<std::int32_t>(v), done, packed);
    }
  });
  return -1;
}

}  // namespace thimble::render
