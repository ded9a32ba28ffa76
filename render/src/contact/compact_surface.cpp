#include "thimble/render/contact/compact_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <utility>

#include "contact/corner_normals.h"
#include "contact/half_edges.h"
#include "contact/radix_sort.h"
#include "thimble/render/contact/surface_rise.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

std::uint64_t spread_bits(std::uint64_t v) noexcept {
  v = (v | (v << 32)) & 0x0000ffff00000000ffffu;
  v = (v | (v << 16)) & 0x00ff0000ff0000ffu;
  v = (v | (v << 8)) & 0xf00f00f00f00f00fu;
  v = (v | (v << 4)) & 0x30c30c30c30c30c3u;
  return (v | (v << 2)) & 0x9249249249249249u;
}

std::uint64_t cell_of(std::int32_t a, std::int32_t b, std::int32_t c) noexcept {
  const std::int64_t middle = (std::int64_t{a} + b + c) / 3 + (std::int64_t{1} << 30);
  return std::min<std::uint64_t>(static_cast<std::uint64_t>(middle) >> 15, 0xffff);
}

driver::Error refusal(std::size_t triangle, const std::string& why) {
  return driver::Error{"The mesh cannot be touched: triangle " + std::to_string(triangle) + " " +
                       why};
}

std::size_t index(std::int32_t i) noexcept {
  return static_cast<std::size_t>(i);
}

// Says that the record of triangle t stands at place[t] once the keys are sorted.
std::vector<KeyedIndex> sorted_by_place(std::span<const CompactTriangle> records) {
  std::vector<KeyedIndex> order(records.size());
  for (std::size_t t = 0; t < records.size(); ++t) {
    order[t] = {morton_key(records[t]), static_cast<std::int32_t>(t)};
  }
  radix_sort(order);
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

std::uint64_t morton_key(const CompactTriangle& r) noexcept {
  return spread_bits(cell_of(r.x[0], r.x[1], r.x[2])) |
         (spread_bits(cell_of(r.y[0], r.y[1], r.y[2])) << 1) |
         (spread_bits(cell_of(r.z[0], r.z[1], r.z[2])) << 2);
}

driver::Result<CompactSurface> CompactSurface::build(const ContactMesh& mesh,
                                                     const CompactSurfaceOptions& options) {
  TriangleMesh plain;
  std::int32_t vertices = 0;
  for (std::int32_t t = 0; t < mesh.triangle_count(); ++t) {
    plain.triangles.push_back(mesh.corners(t));
    for (const std::int32_t v : mesh.corners(t)) vertices = std::max(vertices, v + 1);
  }
  for (std::int32_t v = 0; v < vertices; ++v) plain.vertices.push_back(mesh.position(v));
  return build(plain, options);
}

driver::Result<CompactSurface> CompactSurface::build(const TriangleMesh& mesh,
                                                     const CompactSurfaceOptions& options) {
  const std::size_t count = mesh.triangles.size();
  if (count == 0) return driver::Error{"The mesh has no triangles."};
  // The search's leaves keep 28 bits of a record's number.
  if (count >= (std::size_t{1} << 28) || mesh.vertices.size() >= (std::size_t{1} << 30)) {
    return driver::Error{"The mesh has more than 2^28 triangles or 2^30 vertices: page it."};
  }
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Vector3d low = Vector3d::Constant(kInfinity), high = -low;
  for (std::size_t t = 0; t < count; ++t) {
    for (const std::int32_t v : mesh.triangles[t]) {
      if (v < 0 || index(v) >= mesh.vertices.size()) {
        return refusal(t, "names vertex " + std::to_string(v) + ", which does not exist.");
      }
      const Vector3d& p = mesh.vertices[index(v)];
      if (!p.allFinite()) return refusal(t, "has a corner that is not a number.");
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
  }
  CompactSurface surface;
  surface.origin_ = low + (high - low) / 2;
  const double half = (high - surface.origin_).cwiseMax(surface.origin_ - low).maxCoeff();
  surface.step_ = half / kLatticeHalf;
  surface.per_step_ = kLatticeHalf / half;
  if (!(surface.step_ > 0) || !std::isfinite(surface.per_step_)) {
    return driver::Error{"The mesh has no extent that can be told from zero."};
  }

  const auto on_lattice = [](double u) noexcept {
    return static_cast<std::int32_t>(std::lrint(std::clamp(u, -kLatticeHalf, kLatticeHalf)));
  };
  const auto place = [&](CompactTriangle& record, const std::array<std::int32_t, 3>& corners) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3d p = surface.to_lattice(mesh.vertices[index(corners[k])]);
      record.x[k] = on_lattice(p.x());
      record.y[k] = on_lattice(p.y());
      record.z[k] = on_lattice(p.z());
    }
  };
  surface.records_.resize(count);
  for (std::size_t t = 0; t < count; ++t) place(surface.records_[t], mesh.triangles[t]);
  std::vector<std::array<std::int32_t, 3>> triangles(count);
  {
    const std::vector<KeyedIndex> order = sorted_by_place(surface.records_);
    for (std::size_t t = 0; t < count; ++t) {
      triangles[t] = mesh.triangles[index(order[t].index)];
      place(surface.records_[t], triangles[t]);
      surface.records_[t].flags = static_cast<std::uint32_t>(order[t].index)
                                  << CompactTriangle::kSourceShift;
    }
  }

  const HalfEdges half_edges(triangles, mesh.vertices.size());
  for (std::size_t t = 0; t < count; ++t) {
    CompactTriangle& record = surface.records_[t];
    for (std::size_t k = 0; k < 3; ++k) {
      record.neighbours[k] = half_edges.opposite(triangles[t][(k + 1) % 3], triangles[t][k]);
      const bool alone = half_edges.opposite(triangles[t][k], triangles[t][(k + 1) % 3]) >= 0;
      if (record.neighbours[k] < 0 || !alone) {
        return refusal(
            index(record.source()),
            "lacks a neighbour of its own, wound like itself, over its edge from vertex " +
                std::to_string(triangles[t][k]) + " to vertex " +
                std::to_string(triangles[t][(k + 1) % 3]) + ".");
      }
    }
  }
  const std::ptrdiff_t flat = assign_corner_normals(mesh.vertices, triangles, half_edges,
                                                    options.crease_angle, surface.records_);
  if (flat >= 0) {
    return refusal(index(surface.records_[static_cast<std::size_t>(flat)].source()),
                   "has no area.");
  }
  surface.rise_ = surface.step_ * rise_above(surface.records_);
  return surface;
}

}  // namespace thimble::render
