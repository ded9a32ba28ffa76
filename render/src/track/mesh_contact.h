#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "mesh/contact_mesh.h"
#include "search/free_space.h"
#include "search/make_search.h"
#include "search/passed_through.h"
#include "thimble/driver/device_state.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/render/contact_state.h"
#include "thimble/render/surface/surface_response.h"
#include "track/concave_constraint.h"
#include "track/offset_tracker.h"
#include "track/surface_tracker.h"

namespace thimble::render {

/// Finds the contact on one mesh: a search along the tip's path while it is free, tracking over the
/// surface while it touches [BP 3.1]. A `Contact` stage of ContactForceLaw.
///
/// `Tracker` is SurfaceTracker, OffsetTracker or NormalProjectionTracker; see there for the
/// guarantees of each. MeshContact and OffsetContact below are aliases for the first two.
template <class Tracker>
class THIMBLE_EXPORT TrackedContact {
 public:
  /// Takes a prepared mesh, the choice of search (make_search), and the tracker's constructor
  /// arguments after mesh and search. Real-time: never from the servo thread.
  template <class... TrackerOptions>
  TrackedContact(ContactMesh mesh, std::optional<SearchChoice> search, TrackerOptions... options)
      : mesh_(std::make_shared<const ContactMesh>(std::move(mesh))),
        search_(make_search(*mesh_, search)),
        tracker_(*mesh_, *search_, options...) {}

  /// Takes a mesh and a search over it that another object moves (moving_mesh.h), and the tracker's
  /// constructor arguments after them. Real-time: never from the servo thread.
  template <class... TrackerOptions>
  TrackedContact(std::shared_ptr<const ContactMesh> mesh,
                 std::shared_ptr<const ContactSearch> search, TrackerOptions... options)
      : mesh_(std::move(mesh)),
        search_(std::move(search)),
        tracker_(*mesh_, *search_, options...) {}

  /// Takes a prepared mesh and chooses a suitable search. Real-time: never from the servo thread.
  explicit TrackedContact(ContactMesh mesh) : TrackedContact(std::move(mesh), std::nullopt) {}

  /// Prepares a mesh (W, m); the error is that of ContactMesh::build.
  /// Real-time: never from the servo thread.
  static driver::Result<TrackedContact> build(const TriangleMesh& mesh,
                                              const ContactMeshOptions& options = {},
                                              std::optional<SearchChoice> search = {}) {
    auto prepared = ContactMesh::build(mesh, options);
    if (!prepared) return prepared.error();
    return TrackedContact(std::move(prepared).value(), search);
  }

  /// A copy shares mesh and search, and does not allocate.
  static constexpr bool kCopiesCheaply = true;

  /// Finds the contact at `state.p_WT` (W, m) and keeps it until the next call.
  ///
  /// Contact begins when the path since the last tick enters the mesh, at any speed, and the
  /// tracker runs in the same tick. A tip that is inside on the first tick touches nothing until it
  /// has been outside; otherwise it would be thrown out. A tip that comes out behind a thin part is
  /// held by the face that it has passed through (passed_through.h), until it is back or past the
  /// rim. A position that is NaN or beyond `kPositionMax` ends the contact and makes the next tick
  /// a first one. In the tick that ends a contact no new one begins, unless the tip is inside.
  /// Real-time: safe; a few ns in contact and far from the mesh, else one search query.
  const ContactState& update(const driver::DeviceState& state) noexcept;

  /// Returns the result of the last `update`. Real-time: safe.
  const ContactState& state() const noexcept { return state_; }

  /// Receives that the surface has moved since the last `update`, and which triangle has swept over
  /// the free tip from outside, -1 for none. The tip then touches that triangle. Real-time: safe.
  void surface_moved(std::int32_t swept_over) noexcept {
    free_space_ = {};
    if (swept_over < 0 || state_.touching || !has_before_) return;
    rest_on(swept_over, p_WT_before_);
  }

  /// Begins contact on a triangle with the proxy at `p_WP` (W, m), whatever the path of the tip:
  /// for a world of several objects (render/src/world). Real-time: safe.
  void begin(std::int32_t triangle, const Eigen::Vector3d& p_WP) noexcept {
    set_free(p_WP);
    rest_on(triangle, p_WP);
  }
  /// Ends the contact, if any, and places the free tip at `p_WT` (W, m). Real-time: safe.
  void set_free(const Eigen::Vector3d& p_WT) noexcept {
    state_ = {};
    follows_ = behind_ = false;
    has_before_ = true;
    p_WT_before_ = p_WT;
  }

  /// Returns the position of a free tip in the last `update`, m in W, for surfaces that may sweep
  /// over it; NaN if there was none, or it touches. Real-time: safe.
  Eigen::Vector3d free_tip() const noexcept {
    if (has_before_ && !state_.touching) return p_WT_before_;
    return Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  }

  /// Returns the weights of the tip's place on the active triangle (surface_weights.h).
  /// Precondition: the last `update` was at `p_WT` (W, m) and touches. Real-time: safe.
  Eigen::Vector3d weights(const Eigen::Vector3d& p_WT) const noexcept {
    return tracker_.weights(p_WT);
  }

  /// Returns the concave edge or corner that holds the tip, as of the last `update`; its triangle
  /// is -1 if a face holds it. Real-time: safe.
  decltype(auto) held() const noexcept { return tracker_.held(); }

  /// Returns the surface point of the tip at `p_WT` (W, m) (surface_response.h). Precondition: as
  /// of `weights`. Real-time: safe.
  ClosestSurfacePoint closest(const Eigen::Vector3d& p_WT) const noexcept {
    if (held().triangle >= 0) return resting_closest_point(mesh(), held(), state_);
    return closest_on_triangle(p_WT);
  }
  /// Returns the surface point on the active triangle, even if an edge next to it holds the tip.
  /// Precondition: as of `weights`. Real-time: safe.
  ClosestSurfacePoint closest_on_triangle(const Eigen::Vector3d& p_WT) const noexcept {
    if constexpr (kHasTrianglePlace) {
      return closest_at(tracker_.closest(p_WT));
    } else {
      return flat_closest_point(state_);
    }
  }

  /// Whether the tracker provides the weights of the corners and their derivatives.
  static constexpr bool kHasTrianglePlace =
      requires(const Tracker& tracker, const Eigen::Vector3d& p) {
    tracker.closest(p);
  };
  /// Returns the place on the active triangle with its derivatives. Precondition: as of `weights`.
  /// Real-time: safe.
  TrianglePlace triangle_place(const Eigen::Vector3d& p_WT) const noexcept requires
      kHasTrianglePlace {
    return tracker_.closest(p_WT);
  }
  /// Returns the surface point at such a place. Real-time: safe.
  ClosestSurfacePoint closest_at(const TrianglePlace& place) const noexcept requires
      kHasTrianglePlace {
    if constexpr (kReadsAtProxy) {
      ClosestSurfacePoint closest = flat_closest_point(state_);
      closest.fall_W = tracker_.fall(place);
      return closest;
    }
    const MovingPoint path = path_of(mesh(), place);
    return {.p_M = path.p_W, .n_M = state_.n_W, .J_MT = path.J, .fall_W = tracker_.fall(place)};
  }

  TrackerCounters counters() const noexcept { return tracker_.counters(); }
  const Tracker& tracker() const noexcept { return tracker_; }
  const ContactMesh& mesh() const noexcept { return *mesh_; }
  const ContactSearch& search() const noexcept { return *search_; }

 private:
  void rest_on(std::int32_t triangle, const Eigen::Vector3d& p_WP) noexcept {
    tracker_.start(triangle);
    follows_ = true;
    state_.touching = true;
    state_.triangle = triangle;
    state_.n_W = mesh_->cell(triangle).face.n;
    state_.p_WP = p_WP;
  }
  // Adapter of the mesh for face_above.
  struct Faces {
    const ContactMesh& mesh;
    const Eigen::Vector3d& corner(std::int32_t triangle, std::size_t k) const noexcept {
      return mesh.position(triangle, k);
    }
    const Eigen::Vector3d& normal(std::int32_t triangle) const noexcept {
      return mesh.cell(triangle).face.n;
    }
    std::int32_t neighbour(std::int32_t triangle, std::size_t k) const noexcept {
      return mesh.cell(triangle).neighbours[k];
    }
  };

  // Whether the surface point is the proxy.
  static constexpr bool kReadsAtProxy = requires { Tracker::kReadsAtProxy; };

  // Whether the tracker can continue from a face that does not hold the tip by its own rules.
  static constexpr bool kHoldsBehind = requires(Tracker & tracker, const Eigen::Vector3d& p) {
    tracker.hold_by_face(0, p);
  };

  void report(const Eigen::Vector3d& p_WT, const TrackerStep& step) noexcept;
  // Rare cases.
  [[gnu::noinline, gnu::cold]] const ContactState& lose(const Eigen::Vector3d& p_WT,
                                                        std::uint16_t hops) noexcept;
  [[gnu::noinline, gnu::cold]] const ContactState& retrack(const Eigen::Vector3d& p_WT,
                                                           const TrackerStep& step) noexcept;
  [[gnu::noinline, gnu::cold]] const ContactState& stay_behind(
      const Eigen::Vector3d& p_WT) noexcept;
  bool hold_behind(const Eigen::Vector3d& p_WT) noexcept;

  // On the heap, so that pointers of search and tracker stay valid when the contact is moved.
  std::shared_ptr<const ContactMesh> mesh_;
  std::shared_ptr<const ContactSearch> search_;
  Tracker tracker_;
  ContactState state_;
  FreeSpace free_space_;
  Eigen::Vector3d p_WT_before_{0, 0, 0};
  bool has_before_ = false;
  bool follows_ = false;  // touching, according to the tracker
  bool behind_ = false;   // touching, held behind a thin part
};

template <class Tracker>
const ContactState& TrackedContact<Tracker>::update(const driver::DeviceState& state) noexcept {
  const Eigen::Vector3d& p_WT = state.p_WT;
  if (!within_range(p_WT)) {
    state_ = {};
    has_before_ = follows_ = behind_ = false;
    return state_;
  }
  if (!follows_) {
    if constexpr (kHoldsBehind) {
      if (behind_) [[unlikely]]
        return stay_behind(p_WT);
    }
    if (has_before_) {
      const Entry entry = free_space_.first_entry(*search_, p_WT_before_, p_WT);
      follows_ = entry.triangle >= 0;
      if (follows_) {
        tracker_.start(entry.triangle);
        state_.triangle = entry.triangle;
        state_.n_W = mesh_->cell(entry.triangle).face.n;
      }
    }
    if (!follows_) {
      p_WT_before_ = p_WT;
      has_before_ = true;
      state_ = {};
      return state_;
    }
  }
  p_WT_before_ = p_WT;
  const TrackerStep step = tracker_.follow(p_WT);
  if (!step.touching) [[unlikely]]
    return lose(p_WT, step.hops);
  if constexpr (kHoldsBehind) {
    if (step.hops > 0 && !(tracker_.normal().dot(state_.n_W) > kBeyondRim)) [[unlikely]]
      return retrack(p_WT, step);
  }
  report(p_WT, step);
  return state_;
}

template <class Tracker>
inline void TrackedContact<Tracker>::report(const Eigen::Vector3d& p_WT,
                                            const TrackerStep& step) noexcept {
  state_.touching = true;
  state_.triangle = tracker_.active();
  state_.depth = step.depth;
  state_.n_W = tracker_.normal();
  state_.p_WP = p_WT + step.depth * state_.n_W;
  state_.hops = step.hops;
}

// The tracker has lost the tip: the tip is outside.
template <class Tracker>
const ContactState& TrackedContact<Tracker>::lose(const Eigen::Vector3d& p_WT,
                                                  std::uint16_t hops) noexcept {
  follows_ = false;
  if constexpr (kHoldsBehind) {
    if (hold_behind(p_WT)) return state_;
  }
  state_ = {};
  state_.hops = hops;
  return state_;
}

// The tracker has crossed a rim in one tick. Either the tip went around it too, or it has passed
// through the part.
template <class Tracker>
const ContactState& TrackedContact<Tracker>::retrack(const Eigen::Vector3d& p_WT,
                                                     const TrackerStep& step) noexcept {
  if (search_->inside(p_WT) || !hold_behind(p_WT)) report(p_WT, step);
  return state_;
}

// A tick that begins behind a thin part.
template <class Tracker>
const ContactState& TrackedContact<Tracker>::stay_behind(const Eigen::Vector3d& p_WT) noexcept {
  p_WT_before_ = p_WT;
  const std::int32_t last = state_.triangle;
  if (hold_behind(p_WT)) return state_;
  behind_ = false;
  tracker_.start(last);
  const TrackerStep step = tracker_.follow(p_WT);
  follows_ = step.touching;
  state_ = {};
  state_.hops = step.hops;
  if (follows_) report(p_WT, step);
  return state_;
}

// Holds the tip by the face that it has passed through. Returns false if there is none.
template <class Tracker>
bool TrackedContact<Tracker>::hold_behind(const Eigen::Vector3d& p_WT) noexcept {
  const FaceAbove face = face_above(Faces{*mesh_}, state_.triangle, p_WT);
  if (face.triangle < 0) return false;
  const bool inside = search_->inside(p_WT);
  const double longest = (mesh_->box_max() - mesh_->box_min()).maxCoeff();
  const auto first_entry = [this](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    return search_->first_entry(from, to);
  };
  if (inside ? !behind_ : !behind_thin_part(p_WT, face.depth, face.n, longest, first_entry)) {
    return false;
  }
  // If the tracker itself holds the tip from there, the next tick will feel the same.
  tracker_.start(face.triangle);
  const TrackerStep step = tracker_.follow(p_WT);
  follows_ =
      step.touching && tracker_.normal().dot(face.n) > (inside ? kPushesOutBehind : kBeyondRim);
  behind_ = !follows_;
  if (follows_) {
    report(p_WT, step);
  } else {
    tracker_.hold_by_face(face.triangle, p_WT);
    report(p_WT, {.touching = true, .depth = face.depth, .hops = 0});
  }
  return true;
}

/// Tracks over edge planes [BP 4b]: flat faces, the least work per tick.
using MeshContact = TrackedContact<SurfaceTracker>;

/// SurfaceTracker for a surface with maps, whose surface point is the proxy, straight above the
/// tip.
///
/// The point by the distances to the edge planes is continuous over the edges of even meshes, as
/// textures need it, but below large triangles with sharp edges it is up to the depth away. A map
/// is read where it is seen. Where the proxy jumps from face to face, MapFollower leads the value
/// on.
class ProxyPointTracker : public SurfaceTracker {
 public:
  static constexpr bool kReadsAtProxy = true;
  using SurfaceTracker::SurfaceTracker;
};

/// Tracks over edge planes, on a surface with maps.
using MappedMeshContact = TrackedContact<ProxyPointTracker>;

/// Tracks the smooth surface: Phong normal and the depth along it, continuous over smooth edges and
/// vertices at every depth.
using OffsetContact = TrackedContact<OffsetTracker>;

extern template class TrackedContact<SurfaceTracker>;
extern template class TrackedContact<ProxyPointTracker>;
extern template class TrackedContact<OffsetTracker>;

}  // namespace thimble::render
