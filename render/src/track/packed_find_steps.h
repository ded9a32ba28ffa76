#pragma once

// Recovery of a contact that the walk has lost: function bodies of PackedContact, included only by
// packed_contact_steps.h.

#include <Eigen/Geometry>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "compact_mesh/outside_offset.h"
#include "mesh/closest_point.h"
#include "mesh/triangle_set.h"
#include "track/packed_contact.h"

namespace thimble::render {

// Searches the surface around the begin and the end of the walk for the nearest triangle that has
// the tip below it.
template <PackedStore Store>
typename PackedContact<Store>::Outcome PackedContact<Store>::find_near(
    const Eigen::Vector3d& p, std::int32_t before) noexcept {
  using Eigen::Vector3d;
  TriangleSet<kPatchMax> patch;
  patch.add(active_);
  patch.add(before);
  std::int32_t best = -1;
  double best_squared = std::numeric_limits<double>::infinity();
  double best_depth = 0;
  for (std::size_t i = 0; i < patch.size(); ++i) {
    const std::int32_t t = patch[i];
    const PackedTriangle* packed = store_.find(t);
    if (absent(packed)) return Outcome::kUnknown;
    const PackedTriangle& r = *packed;
    const Vector3d a = r.corner(0), b = r.corner(1), c = r.corner(2);
    const Vector3d area = (b - a).cross(c - a);
    const double depth = area.dot(a - p) / std::sqrt(area.squaredNorm());
    for (const std::int32_t neighbour : r.neighbours) patch.add(neighbour);
    if (!(depth >= -kPlaced)) continue;
    const double squared = (closest_point(p, a, b, c) - p).squaredNorm();
    if (squared < best_squared || (squared == best_squared && depth > best_depth)) {
      best = t;
      best_squared = squared;
      best_depth = depth;
    }
  }
  return best >= 0 && activate(best) ? Outcome::kYes : Outcome::kNo;
}

template <PackedStore Store>
typename PackedContact<Store>::Outcome PackedContact<Store>::find_again(
    const Eigen::Vector3d& p_WT, const Eigen::Vector3d& p, std::int32_t before) noexcept {
  // A walk that reached its bound may have ended anywhere, so the triangles around are not used.
  const Outcome near = state_.hops < kWalkMax ? find_near(p, before) : Outcome::kNo;
  if (near == Outcome::kYes) ++counters_.found_near;
  if (near != Outcome::kNo) return near;
  const FoundTriangle nearest = store_.closest(p_WT, std::numeric_limits<double>::infinity());
  if (!nearest.complete) return Outcome::kUnknown;
  if (nearest.triangle < 0 || !activate(nearest.triangle)) return Outcome::kNo;
  ++counters_.found_far;
  return Outcome::kYes;
}

// Continues at the surface nearest to the tip if the way there from the active triangle is absent.
// If that surface faces the other way, it is the back of a thin part; then continues at the surface
// nearest to the last contact.
template <PackedStore Store>
typename PackedContact<Store>::Outcome PackedContact<Store>::resume(
    const Eigen::Vector3d& p_WT, const ContactState& last) noexcept {
  const FoundTriangle by_tip = store_.closest(p_WT, store_.reach());
  if (!by_tip.complete) return Outcome::kUnknown;
  std::int32_t nearest = by_tip.triangle;
  if (nearest >= 0 && !activate(nearest)) return Outcome::kUnknown;
  if (nearest < 0 || offset_.face().dot(last.n_W) < 0) {
    const FoundTriangle by_plane = store_.closest(last.p_WP, store_.reach());
    if (!by_plane.complete) return Outcome::kUnknown;
    if (by_plane.triangle >= 0) nearest = by_plane.triangle;
    if (nearest < 0) return Outcome::kNo;
    if (!activate(nearest)) return Outcome::kUnknown;
  }
  const Eigen::Vector3d p = store_.to_lattice(p_WT);
  const PackedTriangle* packed = store_.find(active_);
  if (absent(packed)) return Outcome::kUnknown;
  const OffsetResponse beside = feel_nearest(p, *packed, offset_);
  OffsetPlace place = offset_.locate(p);
  state_.hops = 0;
  state_.n_W = offset_.face();  // direction of the walk
  const Outcome settled = settle(p, false, place);
  if (settled == Outcome::kUnknown) return settled;
  // Much deeper than the triangle where it began: a cell of another part.
  const bool astray = place.depth > 2 * beside.depth && beside.depth > 0;
  if (settled == Outcome::kYes && !astray) {
    const OffsetResponse felt = offset_.feel(place);
    if (felt.depth >= 0) {
      report(p_WT, felt);
      return Outcome::kYes;
    }
  }
  const Known inside = store_.inside(p_WT);
  if (inside == Known::kYes) {
    if (!activate(nearest)) return Outcome::kUnknown;
    report(p_WT, beside);
  }
  return inside;
}

}  // namespace thimble::render
