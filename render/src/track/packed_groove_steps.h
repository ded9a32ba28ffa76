#pragma once

// The edge or corner that holds a tip at a concave crease: function bodies of PackedContact,
// included only by packed_contact_steps.h. The same as concave_constraint.h for packed triangles.

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "mesh/triangle_closest_point.h"
#include "mesh/triangle_set.h"
#include "track/packed_contact.h"

namespace thimble::render {

/// Returns the closest point to `p` (steps of the lattice) on a packed triangle. Real-time: safe.
inline TriangleClosestPoint packed_closest_point(const PackedTriangle& packed,
                                                 std::int32_t triangle,
                                                 const Eigen::Vector3d& p) noexcept {
  TriangleClosestPoint closest =
      closest_on(packed.corner(0), packed.corner(1), packed.corner(2), p);
  closest.place.triangle = triangle;
  return closest;
}

/// Returns whether edge `k` of `own` is a concave crease: whether the far corner of its neighbour
/// `other` is above `own`. Real-time: safe.
inline bool concave_crease(const PackedTriangle& own, std::size_t k,
                           const PackedTriangle& other) noexcept {
  if (!own.crease(k)) return false;
  const Eigen::Vector3d begin = own.corner(k), end = own.corner((k + 1) % 3);
  const Eigen::Vector3d area = (end - begin).cross(own.corner((k + 2) % 3) - begin);
  for (std::size_t j = 0; j < 3; ++j) {
    const Eigen::Vector3d x = other.corner(j);
    if (x == begin || x == end) continue;
    return area.dot(x - begin) > 0;
  }
  return false;
}

// Lists the packed triangles around corner `k` of a triangle, that one first, up to the capacity;
// kUnknown if one is absent.
template <PackedStore Store>
typename PackedContact<Store>::Outcome PackedContact<Store>::collect_fan(std::int32_t triangle,
                                                                         std::size_t k,
                                                                         Fan& fan) const noexcept {
  const PackedTriangle* packed = store_.find(triangle);
  if (absent(packed)) return Outcome::kUnknown;
  const Eigen::Vector3d vertex = packed->corner(k);
  std::int32_t t = triangle;
  while (!fan.full()) {
    fan.add(t);
    // Continues over the edge that begins at the vertex.
    std::size_t at = 0;
    while (at < 2 && packed->corner(at) != vertex) ++at;
    t = packed->neighbours[at];
    if (fan.has(t)) break;
    packed = store_.find(t);
    if (absent(packed)) return Outcome::kUnknown;
  }
  return Outcome::kYes;
}

// Slides from the active triangle over the surface to the closest point nearby. Returns it if it is
// on a concave crease, where only the crease holds the tip.
template <PackedStore Store>
typename PackedContact<Store>::Outcome PackedContact<Store>::hold_in_groove(
    const Eigen::Vector3d& p, OffsetResponse& felt) noexcept {
  const PackedTriangle* packed = store_.find(active_);
  if (absent(packed)) return Outcome::kUnknown;
  TriangleClosestPoint closest = packed_closest_point(*packed, active_, p);
  Fan fan;
  for (std::size_t examined = 0; closest.place.on != SurfacePlace::On::kFace;) {
    const SurfacePlace place = closest.place;
    packed = store_.find(place.triangle);
    if (absent(packed)) return Outcome::kUnknown;
    fan = {};
    if (place.on == SurfacePlace::On::kEdge) {
      fan.add(place.triangle);
      fan.add(packed->neighbours[place.k]);
    } else if (collect_fan(place.triangle, place.k, fan) == Outcome::kUnknown) {
      return Outcome::kUnknown;
    }
    bool moved = false;
    for (std::size_t i = 1; i < fan.size(); ++i) {
      const PackedTriangle* around = store_.find(fan[i]);
      if (absent(around)) return Outcome::kUnknown;
      const TriangleClosestPoint there = packed_closest_point(*around, fan[i], p);
      // Strictly, so that the same point seen from another triangle does not count as progress.
      if (!(there.distance_squared < closest.distance_squared)) continue;
      closest = there;
      moved = true;
    }
    if (!moved) break;
    ++state_.hops;
    examined += fan.size();
    if (examined > kPatchMax) return Outcome::kNo;
  }
  if (closest.place.on == SurfacePlace::On::kFace) return Outcome::kNo;
  // The fan of the place: an edge's two triangles, or all around a corner.
  const auto sharp = [&](const PackedTriangle& own, std::size_t k) noexcept {
    const PackedTriangle* other = store_.find(own.neighbours[k]);
    return !absent(other) && concave_crease(own, k, *other);
  };
  bool crease = false;
  for (std::size_t i = 0; i < fan.size() && !crease; ++i) {
    const PackedTriangle* around = store_.find(fan[i]);
    if (absent(around)) return Outcome::kUnknown;
    if (closest.place.on == SurfacePlace::On::kEdge) {
      crease = i == 0 && sharp(*around, closest.place.k);
      continue;
    }
    std::size_t at = 0;
    while (at < 2 && around->corner(at) != closest.p_OP) ++at;
    crease = sharp(*around, at) || sharp(*around, (at + 2) % 3);
  }
  const double distance = std::sqrt(closest.distance_squared);
  if (!crease || !(distance > kPlaced)) return Outcome::kNo;
  if (!activate(closest.place.triangle)) return Outcome::kUnknown;
  held_on_ = closest.place.on;
  packed = store_.find(closest.place.triangle);
  if (held_on_ == SurfacePlace::On::kEdge && !absent(packed)) {
    along_ = (packed->corner((closest.place.k + 1) % 3) - packed->corner(closest.place.k))
                 .stableNormalized();
  }
  felt.n_W = (closest.p_OP - p) / distance;
  felt.depth = distance;
  return Outcome::kYes;
}

}  // namespace thimble::render
