#pragma once

// Tracking from triangle to triangle: function bodies of PackedContact, included only by
// packed_contact_steps.h.

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "compact_mesh/outside_offset.h"
#include "mesh/triangle_set.h"
#include "track/packed_contact.h"
#include "track/packed_walk.h"

namespace thimble::render {

/// How far outside a triangle, as a share of its height, the tip may be without a hop. Otherwise
/// rounding on both sides of an edge could send it back and forth (offset_triangle.h). The
/// resulting jump is the same share of the triangle's bulge.
inline constexpr double kOutside = -1e-6;

/// The same at a crease, where the direction jumps and all numbers are in double precision.
inline constexpr double kOutsideOfCrease = -1e-11;

template <PackedStore Store>
typename PackedContact<Store>::Outcome PackedContact<Store>::follow(
    const Eigen::Vector3d& p_WT) noexcept {
  const Eigen::Vector3d p = store_.to_lattice(p_WT);
  const std::int32_t before = active_;
  const bool sliding = recent_hops_ >= 2;
  state_.hops = 0;
  // If the last ticks hopped, this one is likely to hop: the cheap walk first avoids unpacking a
  // triangle that is left at once.
  if (sliding) {
    std::int32_t next = active_;
    // The face is known long before the felt normal of the last tick. At creases cells overlap, so
    // the end of the walk is part of the result.
    const bool smooth = offset_.creases() == 0;
    const Outcome walked = walk(p, smooth ? offset_.face() : state_.n_W, next);
    if (next != active_) activate(next);
    if (walked == Outcome::kUnknown) return Outcome::kUnknown;
  }
  OffsetPlace place = offset_.locate(p);
  const bool held = place.valid && place.l0 >= kOutside && place.l1 >= kOutside &&
                    place.l2 >= kOutside && offset_.creases() == 0;
  const Outcome settled = held ? Outcome::kYes : settle(p, sliding, place);
  if (settled == Outcome::kYes) {
    // No cell holds the tip: usually it is in the gap below a concave crease.
    if (!held && std::min(std::min(place.l0, place.l1), place.l2) < kOutside && place.depth > 0) {
      OffsetResponse felt;
      const Outcome hold = hold_in_groove(p, felt);
      if (hold == Outcome::kUnknown) return hold;
      if (hold == Outcome::kYes) {
        p_WT_held_ = p_WT;
        report(p_WT, felt);
        return hold;
      }
    }
    // Also above the triangle, where the smooth surface bulges beyond the tip.
    const OffsetResponse felt = offset_.feel(place);
    if (felt.depth >= 0) {
      report(p_WT, felt);
      return Outcome::kYes;
    }
  }
  return seek(p_WT, p, before, settled, place);
}

// Decides cases that need more than the active triangle: whether contact has ended, or where it
// continues.
template <PackedStore Store>
typename PackedContact<Store>::Outcome PackedContact<Store>::seek(
    const Eigen::Vector3d& p_WT, const Eigen::Vector3d& p, std::int32_t before, Outcome settled,
    const OffsetPlace& place) noexcept {
  if (settled == Outcome::kUnknown) return settled;
  const Known inside = store_.inside(p_WT);
  if (inside == Known::kUnknown) return Outcome::kUnknown;
  if (inside == Known::kNo) return Outcome::kNo;
  if (settled == Outcome::kYes && place.depth >= 0) {
    // Where the surface is concave, between the triangles and the smooth surface.
    OffsetResponse felt = offset_.feel(place);
    felt.depth = 0;
    report(p_WT, felt);
    return Outcome::kYes;
  }
  const Outcome found = find_again(p_WT, p, before);
  if (found == Outcome::kYes) {
    const PackedTriangle* packed = store_.find(active_);
    if (absent(packed)) return Outcome::kUnknown;
    const OffsetResponse beside = feel_nearest(p, *packed, offset_);
    const std::int32_t nearest = active_;
    // If an offset triangle here holds the tip, the next tick will feel it: the force at a resting
    // tip must not change.
    OffsetPlace there = offset_.locate(p);
    const Outcome again = settle(p, true, there);
    if (again == Outcome::kUnknown) return again;
    if (again == Outcome::kYes) {
      const OffsetResponse felt = offset_.feel(there);
      if (felt.depth >= 0) {
        report(p_WT, felt);
        return again;
      }
    }
    if (!activate(nearest)) return Outcome::kUnknown;
    report(p_WT, beside);
  }
  return found;
}

// Hops from triangle to triangle until one holds the tip; `place` becomes its place there.
template <PackedStore Store>
typename PackedContact<Store>::Outcome PackedContact<Store>::settle(const Eigen::Vector3d& p,
                                                                    bool walked,
                                                                    OffsetPlace& place) noexcept {
  TriangleSet<8> visited;
  for (;;) {
    if (!place.valid) return Outcome::kNo;
    int edge = -1;
    if (edge_to_hop(p, place, edge) == Outcome::kUnknown) return Outcome::kUnknown;
    if (edge < 0) return Outcome::kYes;
    if (state_.hops >= kWalkMax || visited.full()) {
      ++counters_.long_walks;
      return Outcome::kNo;
    }
    visited.add(active_);
    const PackedTriangle* packed = store_.find(active_);
    if (absent(packed)) return Outcome::kUnknown;
    std::int32_t next = packed->neighbours[static_cast<std::size_t>(edge)];
    ++state_.hops;
    if (visited.has(next)) {
      // A gap between offset triangles: all triangles around it are nearly right.
      ++counters_.cycles;
      return Outcome::kYes;
    }
    if (!walked) {
      std::int32_t far = next;
      const Outcome arrived = walk(p, state_.n_W, far);
      if (!visited.has(far)) next = far;
      if (arrived == Outcome::kUnknown) {
        activate(next);
        return Outcome::kUnknown;
      }
      walked = true;
    }
    if (!activate(next)) return Outcome::kUnknown;
    place = offset_.locate(p);
  }
}

// Makes a packed triangle active. Returns false if it is absent.
template <PackedStore Store>
bool PackedContact<Store>::activate(std::int32_t triangle) noexcept {
  const PackedTriangle* packed = store_.find(triangle);
  if (absent(packed)) return false;
  active_ = triangle;
  if (wide_) {
    offset_.unpack_wide(*packed);
  } else {
    offset_.unpack_plain(*packed);
  }
  if constexpr (Store::kComplete) {
    // The tip goes to one of these, now or in a later tick.
    for (const std::int32_t t : packed->neighbours) __builtin_prefetch(store_.find(t));
  }
  return true;
}

// Prefetches the packed triangles that the tip may go to next. The next one is known only after
// this one has been examined; loading them one by one would wait for main memory at each hop.
// Packed triangles near in space are near in memory, so the lines around this one contain most of
// the way.
template <PackedStore Store>
inline void PackedContact<Store>::fetch_around(const PackedTriangle& packed) const noexcept {
  if constexpr (Store::kComplete) {
    for (const std::int32_t t : packed.neighbours) __builtin_prefetch(store_.find(t));
  }
  // Addresses, since some may be outside of all packed triangles: prefetching those has no effect,
  // and no pointer may be moved there. NOLINTBEGIN(performance-no-int-to-ptr)
  constexpr std::uintptr_t kAround = 4, kLine = sizeof(PackedTriangle);
  const auto here = reinterpret_cast<std::uintptr_t>(&packed);
  for (std::uintptr_t i = 1; i <= kAround; ++i) {
    __builtin_prefetch(reinterpret_cast<const void*>(here + i * kLine));
    __builtin_prefetch(reinterpret_cast<const void*>(here - i * kLine));
  }
  // NOLINTEND(performance-no-int-to-ptr)
}

// Returns the edge that the tip is farthest outside of, as a share of the triangle's height; -1 if
// the triangle holds the tip.
template <PackedStore Store>
typename PackedContact<Store>::Outcome PackedContact<Store>::edge_to_hop(const Eigen::Vector3d& p,
                                                                         const OffsetPlace& place,
                                                                         int& edge) const noexcept {
  std::array<double, 3> side{place.l2, place.l0, place.l1};
  std::array<double, 3> least{kOutside, kOutside, kOutside};
  if (offset_.creases() != 0) {
    const PackedTriangle* own = store_.find(active_);
    if (absent(own)) return Outcome::kUnknown;
    for (std::size_t k = 0; k < 3; ++k) {
      if (((offset_.creases() >> k) & 1u) == 0) continue;
      const PackedTriangle* other = store_.find(own->neighbours[k]);
      if (absent(other)) return Outcome::kUnknown;
      side[k] = side_of_crease(p, *own, k, *other);
      least[k] = kOutsideOfCrease;
    }
  }
  std::size_t worst = 0;
  if (side[1] - least[1] < side[0] - least[0]) worst = 1;
  if (side[2] - least[2] < side[worst] - least[worst]) worst = 2;
  edge = side[worst] < least[worst] ? static_cast<int>(worst) : -1;
  return Outcome::kYes;
}

// Walks over the packed triangles themselves, seen along `n`. Stops at creases and at the last
// packed triangle in memory.
template <PackedStore Store>
typename PackedContact<Store>::Outcome PackedContact<Store>::walk(const Eigen::Vector3d& p,
                                                                  const Eigen::Vector3d& n,
                                                                  std::int32_t& triangle) noexcept {
  const PackedWalk way(p, n);
  const PackedTriangle* packed = store_.find(triangle);
  if (absent(packed)) return Outcome::kUnknown;
  for (; state_.hops < kWalkMax; ++state_.hops) {
    const int edge = way.edge_to_hop(*packed);
    if (edge < 0) break;
    const std::int32_t next = packed->neighbours[static_cast<std::size_t>(edge)];
    packed = store_.find(next);
    if (absent(packed)) return Outcome::kUnknown;
    triangle = next;
    fetch_around(*packed);
  }
  return Outcome::kYes;
}

}  // namespace thimble::render
