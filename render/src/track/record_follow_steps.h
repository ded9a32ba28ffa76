#pragma once

// How the contact goes from triangle to triangle: bodies of RecordContact, included by
// record_contact_steps.h alone.

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "mesh/triangle_set.h"
#include "packed/beside_lowered.h"
#include "track/record_contact.h"
#include "track/record_walk.h"

namespace thimble::render {

/// Is how far outside a triangle, as a share of its height, the tip may be and stay: rounding on
/// both sides of an edge must not send it back and forth (lowered_triangle.h). The jump that this
/// leaves is so small a share of the triangle's bulge.
inline constexpr double kOutside = -1e-6;

/// Is the same at a crease, where the direction jumps and everything is in double precision.
inline constexpr double kOutsideOfCrease = -1e-11;

template <RecordStore Store>
typename RecordContact<Store>::Outcome RecordContact<Store>::follow(
    const Eigen::Vector3d& p_WT) noexcept {
  const Eigen::Vector3d p = store_.to_lattice(p_WT);
  const std::int32_t before = active_;
  const bool sliding = haste_ >= 2;
  state_.hops = 0;
  // Who hopped in the last ticks will hop again: the cheap walk first spares looking closely at a
  // triangle that is left at once.
  if (sliding) {
    std::int32_t next = active_;
    // The face is known long before what the last tick felt. Where there are creases cells overlap,
    // and where the walk ends is part of the answer.
    const bool smooth = lowered_.creases() == 0;
    const Outcome walked = walk(p, smooth ? lowered_.face() : state_.n_W, next);
    if (next != active_) activate(next);
    if (walked == Outcome::kUnknown) return Outcome::kUnknown;
  }
  LoweredPlace place = lowered_.locate(p);
  const bool held = place.valid && place.l0 >= kOutside && place.l1 >= kOutside &&
                    place.l2 >= kOutside && lowered_.creases() == 0;
  const Outcome settled = held ? Outcome::kYes : settle(p, sliding, place);
  if (settled == Outcome::kYes) {
    // Above the triangle too, where the surface that it stands for bulges beyond the tip.
    const LoweredFeel felt = lowered_.feel(place);
    if (felt.depth >= 0) {
      report(p_WT, felt);
      return Outcome::kYes;
    }
  }
  return seek(p_WT, p, before, settled, place);
}

// Decides what the active triangle alone cannot: whether contact has ended, or where it goes on.
template <RecordStore Store>
typename RecordContact<Store>::Outcome RecordContact<Store>::seek(
    const Eigen::Vector3d& p_WT, const Eigen::Vector3d& p, std::int32_t before, Outcome settled,
    const LoweredPlace& place) noexcept {
  if (settled == Outcome::kUnknown) return settled;
  const Known inside = store_.inside(p_WT);
  if (inside == Known::kUnknown) return Outcome::kUnknown;
  if (inside == Known::kNo) return Outcome::kNo;
  if (settled == Outcome::kYes && place.depth >= 0) {
    // In a hollow, between the triangles and the surface that they stand for.
    LoweredFeel felt = lowered_.feel(place);
    felt.depth = 0;
    report(p_WT, felt);
    return Outcome::kYes;
  }
  const Outcome found = find_again(p_WT, p, before);
  if (found == Outcome::kYes) {
    const CompactTriangle* record = store_.find(active_);
    if (absent(record)) return Outcome::kUnknown;
    const LoweredFeel beside = feel_nearest(p, *record, lowered_);
    const std::int32_t nearest = active_;
    // Where a lowered triangle here holds the tip, that is what the next tick will feel: a tip that
    // stands still must not feel one force now and another then.
    LoweredPlace there = lowered_.locate(p);
    const Outcome again = settle(p, true, there);
    if (again == Outcome::kUnknown) return again;
    if (again == Outcome::kYes) {
      const LoweredFeel felt = lowered_.feel(there);
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
template <RecordStore Store>
typename RecordContact<Store>::Outcome RecordContact<Store>::settle(const Eigen::Vector3d& p,
                                                                    bool walked,
                                                                    LoweredPlace& place) noexcept {
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
    const CompactTriangle* record = store_.find(active_);
    if (absent(record)) return Outcome::kUnknown;
    std::int32_t next = record->neighbours[static_cast<std::size_t>(edge)];
    ++state_.hops;
    if (visited.has(next)) {
      // A gap between lowered triangles: around it all are nearly right.
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
    place = lowered_.locate(p);
  }
}

// Makes a record active; false if it is absent.
template <RecordStore Store>
bool RecordContact<Store>::activate(std::int32_t triangle) noexcept {
  const CompactTriangle* record = store_.find(triangle);
  if (absent(record)) return false;
  active_ = triangle;
  if (wide_) {
    lowered_.unpack_wide(*record);
  } else {
    lowered_.unpack_plain(*record);
  }
  if constexpr (Store::kComplete) {
    // The tip goes to one of these, now or in a later tick.
    for (const std::int32_t t : record->neighbours) __builtin_prefetch(store_.find(t));
  }
  return true;
}

// Asks for the records that the tip may go to next. Which it is, is known only when this one has
// been looked at: who waits for that waits for one line of far memory after another. Records that
// are near in space are near in memory, so most of the way comes with what lies around.
template <RecordStore Store>
inline void RecordContact<Store>::fetch_around(const CompactTriangle& record) const noexcept {
  if constexpr (Store::kComplete) {
    for (const std::int32_t t : record.neighbours) __builtin_prefetch(store_.find(t));
  }
  // Addresses, since some may lie outside of all records: asking for those does nothing, and no
  // pointer may be moved there. NOLINTBEGIN(performance-no-int-to-ptr)
  constexpr std::uintptr_t kAround = 4, kLine = sizeof(CompactTriangle);
  const auto here = reinterpret_cast<std::uintptr_t>(&record);
  for (std::uintptr_t i = 1; i <= kAround; ++i) {
    __builtin_prefetch(reinterpret_cast<const void*>(here + i * kLine));
    __builtin_prefetch(reinterpret_cast<const void*>(here - i * kLine));
  }
  // NOLINTEND(performance-no-int-to-ptr)
}

// Tells the edge that the tip is farthest outside of, as a share of the triangle's height; -1 if
// the triangle holds it.
template <RecordStore Store>
typename RecordContact<Store>::Outcome RecordContact<Store>::edge_to_hop(const Eigen::Vector3d& p,
                                                                         const LoweredPlace& place,
                                                                         int& edge) const noexcept {
  std::array<double, 3> side{place.l2, place.l0, place.l1};
  std::array<double, 3> least{kOutside, kOutside, kOutside};
  if (lowered_.creases() != 0) {
    const CompactTriangle* own = store_.find(active_);
    if (absent(own)) return Outcome::kUnknown;
    for (std::size_t k = 0; k < 3; ++k) {
      if (((lowered_.creases() >> k) & 1u) == 0) continue;
      const CompactTriangle* other = store_.find(own->neighbours[k]);
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

// Walks over the triangles as they lie, seen along `n`; stops at creases and at the last record at
// hand.
template <RecordStore Store>
typename RecordContact<Store>::Outcome RecordContact<Store>::walk(const Eigen::Vector3d& p,
                                                                  const Eigen::Vector3d& n,
                                                                  std::int32_t& triangle) noexcept {
  const RecordWalk way(p, n);
  const CompactTriangle* record = store_.find(triangle);
  if (absent(record)) return Outcome::kUnknown;
  for (; state_.hops < kWalkMax; ++state_.hops) {
    const int edge = way.edge_to_hop(*record);
    if (edge < 0) break;
    const std::int32_t next = record->neighbours[static_cast<std::size_t>(edge)];
    record = store_.find(next);
    if (absent(record)) return Outcome::kUnknown;
    triangle = next;
    fetch_around(*record);
  }
  return Outcome::kYes;
}

}  // namespace thimble::render
