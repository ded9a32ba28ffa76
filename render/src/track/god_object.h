#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "mesh/contact_mesh.h"
#include "mesh/surface_place.h"
#include "search/free_space.h"
#include "search/make_search.h"
#include "thimble/driver/device_state.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/render/contact_state.h"
#include "thimble/render/surface/surface_response.h"

namespace thimble::render {

/// Maximum number of lifts per tick: times the proxy leaves the surface for the tip and is stopped
/// by another part of it. Each lift brings it nearer; one is enough to cross a room from wall to
/// wall and into its corner. After eight, the next tick continues.
inline constexpr int kLiftsMax = 8;

/// Counts of events other than sliding.
struct GodObjectCounters {
  std::uint64_t lifts = 0;       ///< Times the proxy left the surface for a tip in free sight.
  std::uint64_t stopped = 0;     ///< Lifts that ended on another part of the surface.
  std::uint64_t long_walks = 0;  ///< Ticks that reached the bound before the slide ended.
  std::uint64_t found_far = 0;   ///< Contact found again where a surface passes through itself.
  std::uint64_t held = 0;        ///< Ticks that kept the proxy's last place: see `update`.
};

/// Finds the contact with a god-object: a proxy that follows the tip and never enters the mesh
/// [ZS]. A `Contact` stage of ContactForceLaw, used instead of MeshContact.
///
/// While the tip is inside, the proxy slides over the surface to the point closest to the tip
/// nearby. One face holds it, two in a concave edge, or three or more in a corner, all within one
/// tick. The proxy stays on the surface, so it passes no part, however thin: the tip may come out
/// at the back, the proxy does not. If the straight way to the tip is free, the proxy leaves. That
/// way is searched along its whole length, without rounding.
///
/// Frames: W world, T tip, P proxy; O, the mesh's own, is W. No length is compared with a constant
/// in scene units.
class THIMBLE_EXPORT GodObjectContact {
 public:
  /// Takes a prepared mesh and the choice of search (make_search). Real-time: never from the servo
  /// thread.
  explicit GodObjectContact(ContactMesh mesh, std::optional<SearchChoice> search = {});

  /// Takes a mesh and a search over it that another object moves (moving_mesh.h). Real-time: never
  /// from the servo thread.
  GodObjectContact(std::shared_ptr<const ContactMesh> mesh,
                   std::shared_ptr<const ContactSearch> search)
      : mesh_(std::move(mesh)), search_(std::move(search)) {}

  /// Prepares a mesh (O, m); the error is that of ContactMesh::build.
  /// Real-time: never from the servo thread.
  static driver::Result<GodObjectContact> build(const TriangleMesh& mesh,
                                                const ContactMeshOptions& options = {},
                                                std::optional<SearchChoice> search = {});

  /// A copy shares mesh and search, and does not allocate.
  static constexpr bool kCopiesCheaply = true;

  /// Finds the contact at `state.p_WT` (W, m) and keeps it until the next call.
  ///
  /// `p_WP` is the proxy: outside the mesh by about its rounding. `depth` is its distance from the
  /// tip. `n_W` points from the tip to it, or along the surface's normal where the distance is
  /// within rounding. `triangle` is one that the proxy rests on. In a notch narrower than 0.5
  /// degrees, without a way out, the proxy may stay at its last place; such ticks are counted.
  ///
  /// Contact begins when the path since the last tick enters the mesh. A tip that is inside on the
  /// first tick touches nothing until it has been outside. A position that is NaN or beyond
  /// `kPositionMax` ends the contact and makes the next tick a first one. Real-time: safe; one
  /// triangle or a few while touching; one search query for each lift, and while free near the
  /// mesh.
  const ContactState& update(const driver::DeviceState& state) noexcept;

  /// Receives that vertices have moved since the last `update`, and which triangle has swept over
  /// the free tip from outside, -1 for none. The proxy then rests on that triangle. Real-time:
  /// safe.
  void surface_moved(std::int32_t swept_over) noexcept {
    free_space_ = {};
    if (swept_over < 0 || state_.touching || !has_before_) return;
    rest_on(swept_over, p_OP_);
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
    has_before_ = true;
    p_OP_ = p_WT;
  }

  /// Returns the position of a free tip in the last `update`, m in O; NaN if there was none, or it
  /// touches. Real-time: safe.
  Eigen::Vector3d free_tip() const noexcept {
    if (has_before_ && !state_.touching) return p_OP_;
    return Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  }

  /// Returns the result of the last `update`. Real-time: safe.
  const ContactState& state() const noexcept { return state_; }

  /// Returns the surface point of the proxy and its derivative by the tip: over a face, along an
  /// edge, zero in a corner (surface_response.h). Real-time: safe.
  ClosestSurfacePoint closest(const Eigen::Vector3d& p_OT) const noexcept;

  /// Returns the part of the surface on which a touching proxy rests. Real-time: safe.
  const SurfacePlace& place() const noexcept { return place_; }

  const GodObjectCounters& counters() const noexcept { return counters_; }
  const ContactMesh& mesh() const noexcept { return *mesh_; }
  const ContactSearch& search() const noexcept { return *search_; }

 private:
  void rest_on(std::int32_t triangle, const Eigen::Vector3d& p_WP) noexcept {
    place_ = {.triangle = triangle};
    state_.touching = true;
    state_.triangle = triangle;
    state_.n_W = mesh_->cell(triangle).face.n;
    state_.p_WP = p_WP;
  }
  void follow(const Eigen::Vector3d& p_OT) noexcept;

  // On the heap, so that the search's pointer to the mesh stays valid when the contact is moved.
  std::shared_ptr<const ContactMesh> mesh_;
  std::shared_ptr<const ContactSearch> search_;
  ContactState state_;
  FreeSpace free_space_;  // O
  GodObjectCounters counters_;
  Eigen::Vector3d p_OP_{0, 0, 0};  // The proxy; a free proxy is at the tip.
  SurfacePlace place_;             // Place on which a touching proxy rests.
  bool has_before_ = false;
};

}  // namespace thimble::render
