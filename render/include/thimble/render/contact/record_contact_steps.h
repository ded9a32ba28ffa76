#pragma once

// The bodies of RecordContact: included where it is instantiated for a store, and nowhere else.

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "thimble/render/contact/closest_point.h"
#include "thimble/render/contact/record_contact.h"
#include "thimble/render/contact/record_walk.h"

namespace thimble::render {

/// Is how far outside a triangle, as a share of its height, the tip may be and stay: rounding on
/// both sides of an edge must not send it back and forth (lowered_triangle.h). The jump that this
/// leaves is so small a share of the triangle's bulge.
inline constexpr double kOutside = -1e-6;

/// Is the same at a crease, where the direction jumps and everything is in double precision.
inline constexpr double kOutsideOfCrease = -1e-11;

template <RecordStore Store>
const ContactState& RecordContact<Store>::update(const driver::DeviceState& state) noexcept {
  if (wide_) {
    tick_wide(state.p_WT);
  } else {
    tick(state.p_WT);
  }
  return this->state();
}

template <RecordStore Store>
inline void RecordContact<Store>::tick(const Eigen::Vector3d& p_WT) noexcept {
  // Most ticks are spent in the triangle of the last one.
  if (!stay(p_WT)) move(p_WT);
}

template <RecordStore Store>
void RecordContact<Store>::tick_wide(const Eigen::Vector3d& p_WT) noexcept {
  tick(p_WT);
}

// Fills in the state from what is felt in the active triangle.
template <RecordStore Store>
inline void RecordContact<Store>::report(const Eigen::Vector3d& p_WT,
                                         const LoweredFeel& felt) noexcept {
  state_.touching = true;
  state_.triangle = lowered_.source();
  state_.n_W = felt.n_W;
  state_.depth = store_.step() * felt.depth;
  state_.p_WP = p_WT + state_.depth * felt.n_W;
}

// Ends the tick if the tip is where the active triangle, or the one over the edge it has crossed,
// answers alone.
template <RecordStore Store>
inline bool RecordContact<Store>::stay(const Eigen::Vector3d& p_WT) noexcept {
  if (!steady_ || !within_range(p_WT)) return false;
  const Eigen::Vector3d p = store_.to_lattice(p_WT);
  const LoweredPlace place = lowered_.locate(p);
  const double least = std::min(std::min(place.l0, place.l1), place.l2);
  if (!place.valid) return false;
  LoweredFeel felt;
  if (least >= 0) {
    felt = lowered_.feel_within(place);
    if (!(felt.depth >= 0)) return false;
    state_.hops = 0;
    haste_ = 0;
  } else {
    if (!step_over(p, place, felt)) return false;
    state_.hops = 1;
    steady_ = ++haste_ < 2;
  }
  p_WT_before_ = p_WT;
  report(p_WT, felt);
  if constexpr (!Store::kComplete) felt_ = state_;
  return true;
}

// Makes the triangle active that lies over the edge that the tip is outside of; true if it answers
// alone. If not, the way goes on from there.
template <RecordStore Store>
inline bool RecordContact<Store>::step_over(const Eigen::Vector3d& p, const LoweredPlace& place,
                                            LoweredFeel& felt) noexcept {
  const CompactTriangle* record = store_.find(active_);
  if (absent(record)) return false;
  std::size_t edge = place.l2 <= place.l0 ? 0 : 1;
  if (place.l1 < std::min(place.l0, place.l2)) edge = 2;
  if (!activate(record->neighbours[edge]) || lowered_.creases() != 0) return false;
  const LoweredPlace there = lowered_.locate(p);
  const double least = std::min(std::min(there.l0, there.l1), there.l2);
  if (!(there.valid && least >= kOutside)) return false;
  felt = lowered_.feel(there);
  return felt.depth >= 0;
}

template <RecordStore Store>
void RecordContact<Store>::move(const Eigen::Vector3d& p_WT) noexcept {
  if (!within_range(p_WT)) {
    end();
    has_before_ = path_kept_ = false;
    return;
  }
  [[maybe_unused]] const Eigen::Vector3d from = p_WT_before_;
  if (!state_.touching && !begin(p_WT)) return;
  p_WT_before_ = p_WT;
  // Where the tip was out of sight the way from the last triangle says nothing.
  const bool late = !Store::kComplete && path_kept_;
  const bool lost = late || (!Store::kComplete && held_.holding());
  Outcome outcome = lost ? Outcome::kUnknown : follow(p_WT);
  haste_ = state_.hops > 0 ? std::min(haste_ + 1, 3) : std::max(haste_ - 1, 0);
  steady_ = haste_ < 2 && outcome == Outcome::kYes && lowered_.creases() == 0;
  if constexpr (!Store::kComplete) {
    // The one place where an absent record is felt. What the surface tells stays in `state_`, for
    // the walk to go on from.
    if (outcome == Outcome::kUnknown) {
      const ContactState last = felt_.touching ? felt_ : begun_;
      felt_ = last;
      held_.hold(p_WT, felt_);
      felt_.touching = true;
      outcome = resume(p_WT, last);
      if (!lost || outcome == Outcome::kUnknown) ++ticks_held_;
      state_.touching = true;
      if (outcome == Outcome::kUnknown && late) {
        end();
        p_WT_before_ = from;
        return;
      }
    }
    path_kept_ = false;
    if (outcome == Outcome::kUnknown) return;
    if (outcome == Outcome::kYes) {
      felt_ = state_;
      held_.fade(p_WT, felt_);
      steady_ = steady_ && !held_.fading();
      return;
    }
    if (held_.fade_out(p_WT, felt_)) return;
  }
  if (outcome != Outcome::kYes) {
    const std::uint16_t hops = state_.hops;
    end();
    state_.hops = hops;
    if constexpr (!Store::kComplete) felt_.hops = hops;
    above_ = true;
  }
}

template <RecordStore Store>
void RecordContact<Store>::end() noexcept {
  state_ = {};
  steady_ = false;
  above_ = false;
  haste_ = 0;
  if constexpr (!Store::kComplete) {
    felt_ = {};
    held_.drop();
  }
}

// Looks for the triangle through which the path since the last tick enters, and makes it active.
template <RecordStore Store>
bool RecordContact<Store>::begin(const Eigen::Vector3d& p_WT) noexcept {
  FoundEntry found;
  const Eigen::Vector3d from = p_WT_before_;
  if (has_before_) found = store_.first_entry(from, p_WT);
  state_ = {};
  if constexpr (!Store::kComplete) {
    felt_ = {};
    // Who was out of sight may have gone round what the straight way passes through.
    if (path_kept_ && (found.leaves || !found.complete)) found.entry = {};
    if (!found.complete) ++ticks_held_;
    if (found.entry.triangle < 0) path_kept_ = !found.complete;
  }
  if (found.complete) p_WT_before_ = p_WT;
  has_before_ = true;
  if (found.entry.triangle < 0) {
    if constexpr (TellsRise<Store>) {
      if (found.complete) return begin_above(p_WT);
      above_ = false;  // for all that is known
    }
    return false;
  }
  if (!activate(found.entry.triangle)) return false;
  state_.n_W = lowered_.face();
  state_.triangle = lowered_.source();
  state_.p_WP = from + found.entry.parameter * (p_WT - from);
  if constexpr (!Store::kComplete) begun_ = state_;
  return true;
}

// Looks whether the tip has come from above into where the smooth surface bulges beyond its
// triangles, and makes the triangle below it active: there contact begins with depth 0.
template <RecordStore Store>
bool RecordContact<Store>::begin_above(
    const Eigen::Vector3d& p_WT) noexcept requires TellsRise<Store> {
  const double rise = store_.rise();
  if (!(rise > 0)) return false;
  const bool was_above = above_;
  const FoundRecord nearest = store_.closest(p_WT, rise);
  above_ = nearest.complete;
  if (!nearest.complete || nearest.triangle < 0 || !activate(nearest.triangle)) return false;
  state_.n_W = lowered_.face();
  const Eigen::Vector3d p = store_.to_lattice(p_WT);
  LoweredPlace place = lowered_.locate(p);
  const Outcome settled = settle(p, true, place);
  if (!Store::kComplete && settled == Outcome::kUnknown) {
    above_ = false;
    state_ = {};
    return false;
  }
  const bool bulges =
      settled == Outcome::kYes && place.depth < 0 && lowered_.feel(place).depth >= 0;
  // Who is below the triangles has not come from above, nor has who came up through them.
  above_ = place.depth < 0 && (was_above || !bulges);
  if (!bulges || !was_above) {
    state_ = {};
    return false;
  }
  state_.triangle = lowered_.source();
  state_.p_WP = p_WT;
  if constexpr (!Store::kComplete) begun_ = state_;
  return true;
}

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
    const Outcome walked = walk(p, next);
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
    report(p_WT, feel_nearest(p, *record, lowered_));
  }
  return found;
}

// Hops from triangle to triangle until one holds the tip; `place` becomes its place there.
template <RecordStore Store>
typename RecordContact<Store>::Outcome RecordContact<Store>::settle(const Eigen::Vector3d& p,
                                                                    bool walked,
                                                                    LoweredPlace& place) noexcept {
  std::array<std::int32_t, 8> visited;
  std::size_t visits = 0;
  for (;;) {
    if (!place.valid) return Outcome::kNo;
    int edge = -1;
    if (edge_to_hop(p, place, edge) == Outcome::kUnknown) return Outcome::kUnknown;
    if (edge < 0) return Outcome::kYes;
    if (state_.hops >= kWalkMax || visits == visited.size()) {
      ++counters_.long_walks;
      return Outcome::kNo;
    }
    visited[visits++] = active_;
    const auto end = visited.begin() + static_cast<std::ptrdiff_t>(visits);
    const auto is_new = [&](std::int32_t t) { return std::find(visited.begin(), end, t) == end; };
    const CompactTriangle* record = store_.find(active_);
    if (absent(record)) return Outcome::kUnknown;
    std::int32_t next = record->neighbours[static_cast<std::size_t>(edge)];
    ++state_.hops;
    if (!is_new(next)) {
      // A gap between lowered triangles: around it all are nearly right.
      ++counters_.cycles;
      return Outcome::kYes;
    }
    if (!walked) {
      std::int32_t far = next;
      const Outcome arrived = walk(p, far);
      if (is_new(far)) next = far;
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
  lowered_.unpack(*record);
  if constexpr (Store::kComplete) {
    // The tip goes to one of these, now or in a later tick.
    for (const std::int32_t t : record->neighbours) __builtin_prefetch(store_.find(t));
  }
  return true;
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

// Walks over the triangles as they lie, seen along the last tick's normal; stops at creases and at
// the last record at hand.
template <RecordStore Store>
typename RecordContact<Store>::Outcome RecordContact<Store>::walk(const Eigen::Vector3d& p,
                                                                  std::int32_t& triangle) noexcept {
  const RecordWalk way(p, state_.n_W);
  const CompactTriangle* record = store_.find(triangle);
  if (absent(record)) return Outcome::kUnknown;
  for (; state_.hops < kWalkMax; ++state_.hops) {
    const int edge = way.edge_to_hop(*record);
    if (edge < 0) break;
    const std::int32_t next = record->neighbours[static_cast<std::size_t>(edge)];
    record = store_.find(next);
    if (absent(record)) return Outcome::kUnknown;
    triangle = next;
  }
  return Outcome::kYes;
}

// Looks over the surface around where the walk ended and where it began for the nearest triangle
// that has the tip below it.
template <RecordStore Store>
typename RecordContact<Store>::Outcome RecordContact<Store>::find_near(
    const Eigen::Vector3d& p, std::int32_t before) noexcept {
  using Eigen::Vector3d;
  std::array<std::int32_t, kPatchMax> patch;
  std::int32_t size = 0;
  const auto add = [&patch, &size](std::int32_t triangle) noexcept {
    const auto end = patch.begin() + size;
    if (size < kPatchMax && std::find(patch.begin(), end, triangle) == end) {
      patch[static_cast<std::size_t>(size++)] = triangle;
    }
  };
  add(active_);
  add(before);
  std::int32_t best = -1;
  double best_squared = std::numeric_limits<double>::infinity();
  double best_depth = 0;
  for (std::int32_t i = 0; i < size; ++i) {
    const std::int32_t t = patch[static_cast<std::size_t>(i)];
    const CompactTriangle* record = store_.find(t);
    if (absent(record)) return Outcome::kUnknown;
    const CompactTriangle& r = *record;
    const Vector3d a = r.corner(0), b = r.corner(1), c = r.corner(2);
    const Vector3d area = (b - a).cross(c - a);
    const double depth = area.dot(a - p) / std::sqrt(area.squaredNorm());
    for (const std::int32_t neighbour : r.neighbours) add(neighbour);
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

template <RecordStore Store>
typename RecordContact<Store>::Outcome RecordContact<Store>::find_again(
    const Eigen::Vector3d& p_WT, const Eigen::Vector3d& p, std::int32_t before) noexcept {
  const Outcome near = find_near(p, before);
  if (near == Outcome::kYes) ++counters_.found_near;
  if (near != Outcome::kNo) return near;
  const FoundRecord nearest = store_.closest(p_WT, std::numeric_limits<double>::infinity());
  if (!nearest.complete) return Outcome::kUnknown;
  if (nearest.triangle < 0 || !activate(nearest.triangle)) return Outcome::kNo;
  ++counters_.found_far;
  return Outcome::kYes;
}

// Goes on at the surface nearest to the tip, when the way there from the active triangle is not at
// hand; or nearest to what it touched last, if that other one looks the other way: the back of a
// thin part is not what was touched.
template <RecordStore Store>
typename RecordContact<Store>::Outcome RecordContact<Store>::resume(
    const Eigen::Vector3d& p_WT, const ContactState& last) noexcept {
  const FoundRecord by_tip = store_.closest(p_WT, store_.reach());
  if (!by_tip.complete) return Outcome::kUnknown;
  std::int32_t nearest = by_tip.triangle;
  if (nearest >= 0 && !activate(nearest)) return Outcome::kUnknown;
  if (nearest < 0 || lowered_.face().dot(last.n_W) < 0) {
    const FoundRecord by_plane = store_.closest(last.p_WP, store_.reach());
    if (!by_plane.complete) return Outcome::kUnknown;
    if (by_plane.triangle >= 0) nearest = by_plane.triangle;
    if (nearest < 0) return Outcome::kNo;
    if (!activate(nearest)) return Outcome::kUnknown;
  }
  const Eigen::Vector3d p = store_.to_lattice(p_WT);
  const CompactTriangle* record = store_.find(active_);
  if (absent(record)) return Outcome::kUnknown;
  const LoweredFeel beside = feel_nearest(p, *record, lowered_);
  LoweredPlace place = lowered_.locate(p);
  state_.hops = 0;
  state_.n_W = lowered_.face();  // the direction to walk by
  const Outcome settled = settle(p, false, place);
  if (settled == Outcome::kUnknown) return settled;
  // Deeper by far than the triangle where it began: a cell of another part.
  const bool astray = place.depth > 2 * beside.depth && beside.depth > 0;
  if (settled == Outcome::kYes && !astray) {
    const LoweredFeel felt = lowered_.feel(place);
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
