#pragma once

// Function bodies of PackedContact. Include only where it is instantiated for a store.

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>

#include "search/passed_through.h"
#include "track/packed_contact.h"
#include "track/packed_find_steps.h"
#include "track/packed_follow_steps.h"
#include "track/packed_groove_steps.h"

namespace thimble::render {

template <PackedStore Store>
const ContactState& PackedContact<Store>::update(const driver::DeviceState& state) noexcept {
  const Eigen::Vector3d& p_WT = state.p_WT;
  if (wide_) {
    if (!stay_wide(p_WT)) move_wide(p_WT);
  } else {
    if (!stay(p_WT)) move(p_WT);
  }
  return this->state();
}

template <PackedStore Store>
ClosestSurfacePoint PackedContact<Store>::closest(const Eigen::Vector3d& p_WT) const noexcept {
  if (held_on_ != SurfacePlace::On::kFace && p_WT == p_WT_held_) {
    ClosestSurfacePoint closest = flat_closest_point(this->state());
    closest.J_MT.setZero();
    if (held_on_ == SurfacePlace::On::kEdge) closest.J_MT = along_ * along_.transpose();
    return closest;
  }
  const OffsetPlace place = offset_.locate(store_.to_lattice(p_WT));
  if (!place.valid) return flat_closest_point(this->state());
  const PathToSurface way = offset_.path_to_surface(place);
  return {.p_M = p_WT + store_.step() * way.to_surface,
          .n_M = this->state().n_W,
          .J_MT = way.J,
          .fall_W = way.fall};
}

template <PackedStore Store>
bool PackedContact<Store>::stay_wide(const Eigen::Vector3d& p_WT) noexcept {
  return stay(p_WT);
}

template <PackedStore Store>
void PackedContact<Store>::move_wide(const Eigen::Vector3d& p_WT) noexcept {
  move(p_WT);
}

// Fills in the state from what is felt in the active triangle.
template <PackedStore Store>
inline void PackedContact<Store>::report(const Eigen::Vector3d& p_WT,
                                         const OffsetResponse& felt) noexcept {
  state_.touching = true;
  state_.triangle = offset_.source();
  measure(p_WT, felt);
}

template <PackedStore Store>
inline void PackedContact<Store>::measure(const Eigen::Vector3d& p_WT,
                                          const OffsetResponse& felt) noexcept {
  state_.n_W = felt.n_W;
  state_.depth = store_.step() * felt.depth;
  state_.p_WP = p_WT + state_.depth * felt.n_W;
}

// Ends the tick if only the active triangle, or the one over the edge that the tip has crossed, is
// needed.
template <PackedStore Store>
inline bool PackedContact<Store>::stay(const Eigen::Vector3d& p_WT) noexcept {
  if (!steady_) return false;
  const Eigen::Vector3d p = store_.to_lattice(p_WT);
  const OffsetPlace place = offset_.locate(p);
  if (!(place.valid && place.depth <= deepest_)) return false;
  if (!(std::min(std::min(place.l1, place.l2), place.l0) >= 0)) [[unlikely]] {
    std::size_t edge = place.l2 <= place.l0 ? 0 : 1;
    if (place.l1 < std::min(place.l0, place.l2)) edge = 2;
    return wide_ ? step_over_wide(p_WT, p.x(), p.y(), p.z(), edge)
                 : step_over_plain(p_WT, p.x(), p.y(), p.z(), edge);
  }
  const OffsetResponse felt = offset_.feel_within(place);
  if (!(felt.depth >= 0)) return false;
  state_.hops = 0;
  recent_hops_ = 0;
  p_WT_before_ = p_WT;
  // The triangle is known since the tip entered it.
  measure(p_WT, felt);
  if constexpr (!Store::kComplete) felt_ = state_;
  return true;
}

template <PackedStore Store>
bool PackedContact<Store>::step_over_plain(const Eigen::Vector3d& p_WT, double x, double y,
                                           double z, std::size_t edge) noexcept {
  return step_over(p_WT, {x, y, z}, edge);
}

template <PackedStore Store>
bool PackedContact<Store>::step_over_wide(const Eigen::Vector3d& p_WT, double x, double y, double z,
                                          std::size_t edge) noexcept {
  return step_over(p_WT, {x, y, z}, edge);
}

// Makes the triangle over the edge active that the tip is outside of. Returns true if only this
// triangle is needed; otherwise the walk continues from there.
template <PackedStore Store>
inline bool PackedContact<Store>::step_over(const Eigen::Vector3d& p_WT, const Eigen::Vector3d& p,
                                            std::size_t edge) noexcept {
  const PackedTriangle* packed = store_.find(active_);
  if (absent(packed)) return false;
  if (!activate(packed->neighbours[edge]) || offset_.creases() != 0) return false;
  const OffsetPlace there = offset_.locate(p);
  const double least = std::min(std::min(there.l0, there.l1), there.l2);
  if (!(there.valid && least >= kOutside)) return false;
  const OffsetResponse felt = offset_.feel(there);
  if (!(felt.depth >= 0)) return false;
  state_.hops = 1;
  steady_ = ++recent_hops_ < 2;
  p_WT_before_ = p_WT;
  report(p_WT, felt);
  if constexpr (!Store::kComplete) felt_ = state_;
  return true;
}

template <PackedStore Store>
void PackedContact<Store>::move(const Eigen::Vector3d& p_WT) noexcept {
  if (!within_range(p_WT)) {
    end();
    has_before_ = path_kept_ = false;
    return;
  }
  [[maybe_unused]] const Eigen::Vector3d from = p_WT_before_;
  if (!state_.touching && !begin(p_WT)) return;
  p_WT_before_ = p_WT;
  if constexpr (Store::kComplete) {
    if (behind_ && stay_behind(p_WT)) return;
  }
  [[maybe_unused]] const std::int32_t before = active_;
  // If triangles were absent, the way from the last triangle is not known.
  const bool late = !Store::kComplete && path_kept_;
  const bool lost = late || (!Store::kComplete && held_.holding());
  Outcome outcome = lost ? Outcome::kUnknown : follow(p_WT);
  recent_hops_ = state_.hops > 0 ? std::min(recent_hops_ + 1, 3) : std::max(recent_hops_ - 1, 0);
  steady_ = recent_hops_ < 2 && outcome == Outcome::kYes && offset_.creases() == 0;
  if constexpr (!Store::kComplete) {
    // The only place where an absent packed triangle affects what is felt. The tracked contact
    // stays in `state_`, from which the walk continues.
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
  if constexpr (Store::kComplete) {
    if (outcome != Outcome::kYes) {
      if (hold_behind(p_WT, before)) return;
    } else if (state_.hops > 0 && offset_.creases() != 0) {
      if (passed_by_rim(p_WT, before)) return;
    }
  }
  if (outcome != Outcome::kYes) {
    const std::uint16_t hops = state_.hops;
    end();
    state_.hops = hops;
    if constexpr (!Store::kComplete) felt_.hops = hops;
    above_ = true;
  }
}

// Holds a tip outside by the face that it has passed through (passed_through.h). Returns false if
// there is none.
template <PackedStore Store>
bool PackedContact<Store>::hold_behind(const Eigen::Vector3d& p_WT, std::int32_t from) noexcept {
  const FaceAbove face = face_above(Faces{store_}, from, store_.to_lattice(p_WT));
  if (face.triangle < 0) return false;
  const double depth = store_.step() * face.depth;
  const bool inside = store_.inside(p_WT) == Known::kYes;
  const double longest = 2 * kLatticeHalf * store_.step();
  const auto first_entry = [this](const Eigen::Vector3d& p_from, const Eigen::Vector3d& p_to) {
    return store_.first_entry(p_from, p_to).entry;
  };
  if (inside ? !behind_ : !behind_thin_part(p_WT, depth, face.n, longest, first_entry)) {
    return false;
  }
  // If an offset triangle holds the tip from there, the next tick will feel the same.
  steady_ = false;
  recent_hops_ = 0;
  activate(face.triangle);
  state_.n_W = face.n;
  behind_ = !(follow(p_WT) == Outcome::kYes &&
              state_.n_W.dot(face.n) > (inside ? kPushesOutBehind : kBeyondRim));
  if (behind_) {
    activate(face.triangle);
    held_on_ = SurfacePlace::On::kFace;
    state_ = {.touching = true,
              .triangle = offset_.source(),
              .depth = depth,
              .n_W = face.n,
              .p_WP = p_WT + depth * face.n};
  }
  return true;
}

// The walk has crossed edges, one of them a crease. If it was a rim, checks whether the tip has
// gone around it too or has passed through the part. Returns true if the tip is held behind it.
template <PackedStore Store>
bool PackedContact<Store>::passed_by_rim(const Eigen::Vector3d& p_WT,
                                         std::int32_t before) noexcept {
  return !(Faces{store_}.normal(before).dot(state_.n_W) > kBeyondRim) &&
         store_.inside(p_WT) != Known::kYes && hold_behind(p_WT, before);
}

// Performs a tick that begins behind a thin part. Returns false if nothing holds the tip any more.
template <PackedStore Store>
bool PackedContact<Store>::stay_behind(const Eigen::Vector3d& p_WT) noexcept {
  const std::int32_t last = active_;
  if (hold_behind(p_WT, last)) return true;
  behind_ = false;
  activate(last);
  return false;
}

template <PackedStore Store>
void PackedContact<Store>::end() noexcept {
  state_ = {};
  behind_ = false;
  steady_ = false;
  above_ = false;
  recent_hops_ = 0;
  if constexpr (!Store::kComplete) {
    felt_ = {};
    held_.drop();
  }
}

template <PackedStore Store>
void PackedContact<Store>::begin_at(std::int32_t triangle, const Eigen::Vector3d& p_WP) noexcept {
  set_free(p_WP);
  if (!activate(triangle)) return;
  held_on_ = SurfacePlace::On::kFace;
  state_.touching = true;
  state_.n_W = offset_.face();
  state_.triangle = offset_.source();
  state_.p_WP = p_WP;
}

template <PackedStore Store>
void PackedContact<Store>::set_free(const Eigen::Vector3d& p_WT) noexcept {
  if (state_.touching) {
    end();
    above_ = true;
  }
  p_WT_before_ = p_WT;
  has_before_ = true;
}

// Finds the triangle through which the path since the last tick enters, and makes it active.
template <PackedStore Store>
bool PackedContact<Store>::begin(const Eigen::Vector3d& p_WT) noexcept {
  FoundEntry found;
  const Eigen::Vector3d from = p_WT_before_;
  if (has_before_) found = store_.first_entry(from, p_WT);
  state_ = {};
  bool free = found.complete;
  if constexpr (!Store::kComplete) {
    felt_ = {};
    // While triangles were absent, the tip may have gone around what the straight way passes
    // through.
    if (path_kept_ && (found.leaves || !found.complete)) found.entry = {};
    if (!found.complete) ++ticks_held_;
    if (found.entry.triangle < 0) {
      // A long path may never be loaded as a whole. A tip that is outside according to nearby
      // triangles starts a new path.
      free = free || store_.inside(p_WT) == Known::kNo;
      path_kept_ = !free;
    }
  }
  if (free) p_WT_before_ = p_WT;
  has_before_ = true;
  if (found.entry.triangle < 0) {
    if constexpr (HasRise<Store>) {
      if (found.complete) return begin_above(p_WT);
      above_ = false;  // as far as known
    }
    return false;
  }
  if (!activate(found.entry.triangle)) return false;
  state_.n_W = offset_.face();
  state_.triangle = offset_.source();
  state_.p_WP = from + found.entry.parameter * (p_WT - from);
  if constexpr (!Store::kComplete) begun_ = state_;
  return true;
}

// Checks whether the tip has come from above into a bulge of the smooth surface beyond its
// triangles. If so, makes the triangle below it active: contact begins there with depth 0.
template <PackedStore Store>
bool PackedContact<Store>::begin_above(
    const Eigen::Vector3d& p_WT) noexcept requires HasRise<Store> {
  const double rise = store_.rise();
  if (!(rise > 0)) return false;
  const bool was_above = above_;
  const FoundTriangle nearest = store_.closest(p_WT, rise);
  above_ = nearest.complete;
  if (!nearest.complete || nearest.triangle < 0 || !activate(nearest.triangle)) return false;
  state_.n_W = offset_.face();
  const Eigen::Vector3d p = store_.to_lattice(p_WT);
  OffsetPlace place = offset_.locate(p);
  const Outcome settled = settle(p, true, place);
  if (!Store::kComplete && settled == Outcome::kUnknown) {
    above_ = false;
    state_ = {};
    return false;
  }
  const bool bulges = settled == Outcome::kYes && place.depth < 0 && offset_.feel(place).depth >= 0;
  // A tip below the triangles has not come from above, nor has one that came up through them.
  above_ = place.depth < 0 && (was_above || !bulges);
  if (!bulges || !was_above) {
    state_ = {};
    return false;
  }
  state_.triangle = offset_.source();
  state_.p_WP = p_WT;
  if constexpr (!Store::kComplete) begun_ = state_;
  return true;
}

}  // namespace thimble::render
