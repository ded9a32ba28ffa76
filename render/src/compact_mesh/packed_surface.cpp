#include "compact_mesh/packed_surface.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "compact_mesh/block_order.h"
#include "compact_mesh/corner_normals.h"
#include "compact_mesh/sse2.h"
#include "compact_mesh/surface_rise.h"
#include "compact_mesh/unfinished_triangle.h"
#include "mesh/half_edges.h"
#include "mesh/parallel_split.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

driver::Error refusal(std::size_t triangle, const std::string& why) {
  return driver::Error{"The mesh cannot be touched: triangle " + std::to_string(triangle) + " " +
                       why};
}

std::size_t index(std::int32_t i) noexcept {
  return static_cast<std::size_t>(i);
}

// Returns the error that names the first triangle without its own neighbour over each edge.
// Precondition: there is one.
driver::Error first_unpaired(std::span<const PackedTriangle> packed, const HalfEdges& half_edges) {
  std::size_t t = 0, k = 0;
  for (;; k = 0, ++t) {
    const auto& own = unfinished::corners(packed[t]);
    const auto paired = [&](std::size_t edge) {
      const std::int32_t from = own[edge], to = own[(edge + 1) % 3];
      return half_edges.opposite(to, from) >= 0 && half_edges.opposite(from, to) >= 0;
    };
    while (k < 3 && paired(k)) ++k;
    if (k < 3) break;
  }
  const auto& own = unfinished::corners(packed[t]);
  return refusal(index(packed[t].source()),
                 "lacks a unique neighbour of the same orientation across its edge from vertex " +
                     std::to_string(own[k]) + " to vertex " + std::to_string(own[(k + 1) % 3]) +
                     ".");
}

// A corner or a vertex on the lattice.
struct LatticePoint {
  std::int32_t x, y, z;
};

LatticePoint on_lattice(const Vector3d& p) noexcept {
  const auto whole = [](double u) noexcept {
    // Rounds to the nearest, halves to the even one.
    return static_cast<std::int32_t>(std::lrint(std::clamp(u, -kLatticeHalf, kLatticeHalf)));
  };
  return {whole(p.x()), whole(p.y()), whole(p.z())};
}

// Returns the order of the packed triangles.
std::vector<PlacedIndex> order_of(const TriangleMesh& mesh, const PackedSurface& lattice) {
  std::vector<LatticePoint> points(mesh.vertices.size());
  parallel_split(points.size(), [&](std::size_t begin, std::size_t end) noexcept {
    for (std::size_t v = begin; v < end; ++v) {
      points[v] = on_lattice(lattice.to_lattice(mesh.vertices[v]));
    }
  });
  std::vector<PlacedIndex> order(mesh.triangles.size());
  parallel_split(order.size(), [&](std::size_t begin, std::size_t end) noexcept {
    for (std::size_t t = begin; t < end; ++t) {
      const auto& [i, j, k] = mesh.triangles[t];
      const LatticePoint &a = points[index(i)], &b = points[index(j)], &c = points[index(k)];
      const auto middle = [](std::int32_t u, std::int32_t v, std::int32_t w) noexcept {
        return static_cast<float>(u) + static_cast<float>(v) + static_cast<float>(w);
      };
      order[t] = {{middle(a.x, b.x, c.x), middle(a.y, b.y, c.y), middle(a.z, b.z, c.z)},
                  static_cast<std::int32_t>(t)};
    }
  });
  order_in_blocks(order);
  return order;
}

}  // namespace

std::uint32_t pack_normal(const Vector3d& n) noexcept {
  const double sum = std::abs(n.x()) + std::abs(n.y()) + std::abs(n.z());
  double u = n.x() / sum;
  double v = n.y() / sum;
  if (n.z() < 0) {
    const double folded = (1 - std::abs(v)) * std::copysign(1.0, u);
    v = (1 - std::abs(u)) * std::copysign(1.0, v);
    u = folded;
  }
  const auto rounded = [](double w) noexcept {
    return static_cast<std::uint16_t>(
        static_cast<std::int16_t>(std::lrint(w * static_cast<double>(kOctahedron))));
  };
  return rounded(u) | (static_cast<std::uint32_t>(rounded(v)) << 16);
}

Vector3d unpack_normal(std::uint32_t packed) noexcept {
  const double x = static_cast<std::int16_t>(packed & 0xffffu);
  const double y = static_cast<std::int16_t>(packed >> 16);
  const double z = static_cast<double>(kOctahedron) - std::abs(x) - std::abs(y);
  const double fold = std::max(-z, 0.0);
  const Vector3d n(x - std::copysign(fold, x), y - std::copysign(fold, y), z);
  return n / std::sqrt(n.squaredNorm());
}

std::optional<PackedSurface> PackedSurface::restore(const Frame& frame, Triangles triangles) {
  // The same limit as `build`.
  if (triangles.empty() || triangles.size() >= (std::size_t{1} << 28)) return {};
  // Written so that NaN is refused.
  const auto is_length = [](double x) { return x > 0 && std::isfinite(x); };
  if (!is_length(frame.step) || !is_length(frame.per_step) || !(frame.rise >= 0) ||
      !std::isfinite(frame.rise) ||
      !std::all_of(frame.origin.begin(), frame.origin.end(),
                   [](double x) { return std::isfinite(x); })) {
    return {};
  }
  // The servo follows numbers without a check.
  const auto count = static_cast<std::uint32_t>(triangles.size());
  bool valid = true;
  for (const PackedTriangle& triangle : triangles) {
    for (const std::int32_t neighbour : triangle.neighbours) {
      valid &= static_cast<std::uint32_t>(neighbour) < count;  // a negative one is large
    }
    valid &= static_cast<std::uint32_t>(triangle.source()) < count;
  }
  if (!valid) return {};
  PackedSurface surface;
  surface.triangles_ = std::move(triangles);
  surface.origin_ = {frame.origin[0], frame.origin[1], frame.origin[2]};
  surface.step_ = frame.step;
  surface.per_step_ = frame.per_step;
  surface.rise_ = frame.rise;
  return surface;
}

driver::Result<PackedSurface> PackedSurface::build(const ContactMesh& mesh,
                                                   const PackedSurfaceOptions& options) {
  TriangleMesh plain;
  std::int32_t vertices = 0;
  for (std::int32_t t = 0; t < mesh.triangle_count(); ++t) {
    plain.triangles.push_back(mesh.corners(t));
    for (const std::int32_t v : mesh.corners(t)) vertices = std::max(vertices, v + 1);
  }
  for (std::int32_t v = 0; v < vertices; ++v) plain.vertices.push_back(mesh.position(v));
  return build(plain, options);
}

driver::Result<PackedSurface> PackedSurface::build(const TriangleMesh& mesh,
                                                   const PackedSurfaceOptions& options) {
  const std::size_t count = mesh.triangles.size();
  if (count == 0) return driver::Error{"The mesh has no triangles."};
  // The search's leaves store 28 bits of a packed triangle's number.
  if (count >= (std::size_t{1} << 28) || mesh.vertices.size() >= (std::size_t{1} << 30)) {
    return driver::Error{
        "The mesh has 2^28 triangles or 2^30 vertices or more. Convert it to a page "
        "file: thimble mesh page IN OUT"};
  }
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Vector3d low = Vector3d::Constant(kInfinity), high = -low;
  for (std::size_t t = 0; t < count; ++t) {
    for (const std::int32_t v : mesh.triangles[t]) {
      if (v < 0 || index(v) >= mesh.vertices.size()) {
        return refusal(t, "refers to vertex " + std::to_string(v) + ", which does not exist.");
      }
      const Vector3d& p = mesh.vertices[index(v)];
      if (!p.allFinite()) return refusal(t, "has a coordinate that is not finite.");
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
  }
  PackedSurface surface;
  surface.origin_ = low + (high - low) / 2;
  const double half = (high - surface.origin_).cwiseMax(surface.origin_ - low).maxCoeff();
  surface.step_ = half / kLatticeHalf;
  surface.per_step_ = kLatticeHalf / half;
  if (!(surface.step_ > 0) || !std::isfinite(surface.per_step_)) {
    return driver::Error{"The mesh has no measurable extent."};
  }

  Triangles& triangles = surface.triangles_;
  {
    const std::vector<PlacedIndex> order = order_of(mesh, surface);
    triangles.resize(count);
    parallel_split(count, [&](std::size_t begin, std::size_t end) noexcept {
      for (std::size_t t = begin; t < end; ++t) {
        unfinished::corners(triangles[t]) = mesh.triangles[index(order[t].index)];
        triangles[t].flags = static_cast<std::uint32_t>(order[t].index)
                             << PackedTriangle::kSourceShift;
      }
    });
  }
  {
    const HalfEdges half_edges(
        count, mesh.vertices.size(), [&triangles](std::size_t t) -> const auto& {
          return unfinished::corners(triangles[t]);
        });
    // A triangle that shares an edge with another of the same winding is found by the triangle
    // behind that edge, which finds two.
    std::atomic<bool> all_paired = true;
    parallel_split(count, [&](std::size_t begin, std::size_t end) noexcept {
      for (std::size_t t = begin; t < end; ++t) {
        const auto& own = unfinished::corners(triangles[t]);
        for (std::size_t k = 0; k < 3; ++k) {
          const std::int32_t behind = half_edges.opposite(own[(k + 1) % 3], own[k]);
          triangles[t].neighbours[k] = behind;
          if (behind < 0) all_paired = false;
        }
      }
    });
    if (!all_paired) return first_unpaired(triangles, half_edges);
    const std::ptrdiff_t flat =
        assign_corner_normals(mesh.vertices, half_edges, options.crease_angle, triangles);
    if (flat >= 0) {
      return refusal(index(triangles[static_cast<std::size_t>(flat)].source()), "has no area.");
    }
  }
  std::atomic<double> rise = 0;  // steps
  parallel_split(count, [&](std::size_t begin, std::size_t end) noexcept {
    for (std::size_t t = begin; t < end; ++t) {
      const std::array<std::int32_t, 3> own = unfinished::corners(triangles[t]);
      for (std::size_t k = 0; k < 3; ++k) {
        const LatticePoint p = on_lattice(surface.to_lattice(mesh.vertices[index(own[k])]));
        triangles[t].x[k] = p.x;
        triangles[t].y[k] = p.y;
        triangles[t].z[k] = p.z;
      }
    }
    const double highest = rise_above(std::span(triangles).subspan(begin, end - begin));
    double before = rise;
    while (before < highest && !rise.compare_exchange_weak(before, highest)) continue;
  });
  surface.rise_ = surface.step_ * rise;
  return surface;
}

}  // namespace thimble::render
