#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <utility>

#include "compact_mesh/offset_triangle.h"
#include "compact_mesh/wide_lanes.h"
#include "mesh/surface_place.h"
#include "mesh/triangle_set.h"
#include "search/contact_search.h"
#include "thimble/driver/device_state.h"
#include "thimble/driver/export.h"
#include "thimble/render/contact_state.h"
#include "thimble/render/surface/surface_response.h"
#include "track/held_plane.h"
#include "track/packed_store.h"
#include "track/surface_tracker.h"

namespace thimble::render {

/// Finds the contact on a smooth surface of packed triangles: a search while the tip is free,
/// tracking from offset triangle to offset triangle (offset_triangle.h) while it touches. The store
/// provides the packed triangles; InMemoryContact has all of them in memory. The function bodies
/// are in packed_contact_steps.h, for files that instantiate it.
///
/// Depth and direction are continuous over edges and vertices, since neighbours share bit-identical
/// offset edges. Over a crease the tip changes sides at the plane that halves the angle, where both
/// faces measure the same depth [BP 3.1, Fig. 4b], and the direction jumps. Between the two sides
/// of a concave crease the edge or corner itself holds the tip (concave_constraint.h).
///
/// Contact begins at the smooth surface. On a bulge that is above the triangles, by up to L^2 / 6R
/// for edges of length L on a radius R [PHYSICS 3]. There the depth rises from 0, if the store
/// provides the rise of the surface. Where the surface is concave it is below the triangles. There
/// contact begins and ends at the triangles, softly (depth_below_concave). So nothing jumps, and
/// depth is not bent towards the triangles as in CurvedDepth, which begins at the mesh.
///
/// Where a packed triangle is absent, the plane felt last is held (held_plane.h) and the tick is
/// counted. The contact continues from the last triangle in memory, or from the one nearest to the
/// tip if the way there is absent. It ends if there is none within the store's reach. A free tip
/// keeps the path that could not be examined until the tip is known to be outside. An entry found
/// on the path later counts only if the path does not come out again, because the tip may not have
/// gone straight.
template <PackedStore Store>
class THIMBLE_EXPORT PackedContact {
 public:
  /// Takes the store. Real-time: never from the servo thread.
  explicit PackedContact(Store store)
      : store_(std::move(store)),
        deepest_(kPositionMax / store_.step() - 2 * kLatticeHalf -
                 store_.to_lattice(Eigen::Vector3d::Zero()).cwiseAbs().maxCoeff()) {}

  /// Finds the contact at `state.p_WT` (W, m) and keeps it until the next call; `triangle` is the
  /// number of the input's triangle. A tip that is inside on the first tick touches nothing until
  /// it has been outside. A position that is NaN or beyond `kPositionMax` ends the contact and
  /// makes the next tick a first one. Real-time: safe; tens of ns in contact, at worst `kHopsMax`
  /// triangles, `kPatchMax` more and two search queries.
  const ContactState& update(const driver::DeviceState& state) noexcept;

  /// Returns the result of the last `update`. Real-time: safe.
  const ContactState& state() const noexcept {
    if constexpr (Store::kComplete) return state_;
    return felt_;
  }

  /// Begins contact on a triangle with the proxy at `p_WP` (W, m), whatever the path of the tip:
  /// for a world of several objects (render/src/world). Real-time: safe.
  void begin_at(std::int32_t triangle, const Eigen::Vector3d& p_WP) noexcept;
  /// Ends the contact, if any, and places the free tip at `p_WT` (W, m). Real-time: safe.
  void set_free(const Eigen::Vector3d& p_WT) noexcept;

  /// Returns the surface point of the tip at `p_WT` (W, m) (surface_response.h); on the felt plane
  /// if the packed triangle is absent. Precondition: the last `update` was at `p_WT` and touches.
  /// Real-time: safe; some 100 ns.
  ClosestSurfacePoint closest(const Eigen::Vector3d& p_WT) const noexcept;

  /// Returns the number of the active packed triangle. Real-time: safe.
  std::int32_t active() const noexcept { return active_; }
  const TrackerCounters& counters() const noexcept { return counters_; }
  /// Returns the number of ticks in which a packed triangle was absent.
  std::uint64_t ticks_held() const noexcept { return ticks_held_; }
  /// Returns the start of the path that the next tick examines if the tip is free (W, m): the last
  /// tip, or an older one where packed triangles were absent. Real-time: safe.
  const Eigen::Vector3d& path_begin() const noexcept { return p_WT_before_; }
  const Store& store() const noexcept { return store_; }  ///< Source of the packed triangles.

 private:
  // Surfaces that do not fit into memory have triangles of 20 um: at 0.5 m/s a tip crosses 60 of
  // them.
  static constexpr std::uint16_t kWalkMax = Store::kComplete ? kHopsMax : 4 * kHopsMax;

  // Result of a tick in contact: kUnknown if a packed triangle that decides it is absent.
  using Outcome = Known;

  // The triangles around a corner.
  using Fan = TriangleSet<kPatchMax>;

  // Adapter of the packed triangles for face_above, in steps of the lattice.
  struct Faces {
    const Store& store;
    Eigen::Vector3d corner(std::int32_t triangle, std::size_t k) const noexcept {
      return store.find(triangle)->corner(k);
    }
    Eigen::Vector3d normal(std::int32_t triangle) const noexcept {
      const Eigen::Vector3d a = corner(triangle, 0);
      return (corner(triangle, 1) - a).cross(corner(triangle, 2) - a).normalized();
    }
    std::int32_t neighbour(std::int32_t triangle, std::size_t k) const noexcept {
      return store.find(triangle)->neighbours[k];
    }
  };

  // The tick in three parts, so that the first, which is all of most ticks, is short straight-line
  // code. Each is compiled twice for different processors (wide_lanes). The first two return
  // whether the tick is done.
  bool stay(const Eigen::Vector3d& p_WT) noexcept;
  [[gnu::noinline]] THIMBLE_FOR_AVX2 bool stay_wide(const Eigen::Vector3d& p_WT) noexcept;
  bool step_over(const Eigen::Vector3d& p_WT, const Eigen::Vector3d& p, std::size_t edge) noexcept;
  [[gnu::noinline]] bool step_over_plain(const Eigen::Vector3d& p_WT, double x, double y, double z,
                                         std::size_t edge) noexcept;
  [[gnu::noinline]] THIMBLE_FOR_AVX2 bool step_over_wide(const Eigen::Vector3d& p_WT, double x,
                                                         double y, double z,
                                                         std::size_t edge) noexcept;
  void move(const Eigen::Vector3d& p_WT) noexcept;
  [[gnu::noinline]] THIMBLE_FOR_AVX2 void move_wide(const Eigen::Vector3d& p_WT) noexcept;
  // Rare code is not compiled twice.
  [[gnu::noinline]] bool begin(const Eigen::Vector3d& p_WT) noexcept;
  bool begin_above(const Eigen::Vector3d& p_WT) noexcept requires HasRise<Store>;
  Outcome follow(const Eigen::Vector3d& p_WT) noexcept;
  [[gnu::noinline, gnu::cold]] Outcome seek(const Eigen::Vector3d& p_WT, const Eigen::Vector3d& p,
                                            std::int32_t before, Outcome settled,
                                            const OffsetPlace& place) noexcept;
  [[gnu::noinline]] Outcome settle(const Eigen::Vector3d& p, bool walked,
                                   OffsetPlace& place) noexcept;
  [[gnu::noinline, gnu::cold]] Outcome find_again(const Eigen::Vector3d& p_WT,
                                                  const Eigen::Vector3d& p,
                                                  std::int32_t before) noexcept;
  [[gnu::noinline, gnu::cold]] Outcome resume(const Eigen::Vector3d& p_WT,
                                              const ContactState& last) noexcept;
  Outcome find_near(const Eigen::Vector3d& p, std::int32_t before) noexcept;
  Outcome walk(const Eigen::Vector3d& p, const Eigen::Vector3d& n, std::int32_t& triangle) noexcept;
  Outcome edge_to_hop(const Eigen::Vector3d& p, const OffsetPlace& place, int& edge) const noexcept;
  [[gnu::noinline, gnu::cold]] Outcome hold_in_groove(const Eigen::Vector3d& p,
                                                      OffsetResponse& felt) noexcept;
  Outcome collect_fan(std::int32_t triangle, std::size_t k, Fan& fan) const noexcept;
  bool activate(std::int32_t triangle) noexcept;
  void fetch_around(const PackedTriangle& packed) const noexcept;
  void report(const Eigen::Vector3d& p_WT, const OffsetResponse& felt) noexcept;
  void measure(const Eigen::Vector3d& p_WT, const OffsetResponse& felt) noexcept;
  [[gnu::noinline]] void end() noexcept;
  [[gnu::noinline, gnu::cold]] bool hold_behind(const Eigen::Vector3d& p_WT,
                                                std::int32_t from) noexcept;
  [[gnu::noinline, gnu::cold]] bool passed_by_rim(const Eigen::Vector3d& p_WT,
                                                  std::int32_t before) noexcept;
  [[gnu::noinline, gnu::cold]] bool stay_behind(const Eigen::Vector3d& p_WT) noexcept;

  static bool absent(const PackedTriangle* packed) noexcept {
    return !Store::kComplete && packed == nullptr;
  }

  // Members used by each tick come first.
  Store store_;
  bool wide_ = wide_lanes();
  bool steady_ = false;  // in contact, at no crease, and with few hops in the last ticks
  bool has_before_ = false;
  bool behind_ = false;     // in contact, held behind a thin part by the active triangle
  bool path_kept_ = false;  // whether the path began before the last tick
  bool above_ = false;      // free, and known to be above the smooth surface
  int recent_hops_ = 0;     // incremented up to 3 by ticks that hop, decremented by others
  std::int32_t active_ = -1;
  double deepest_;  // steps; a tip within a triangle and no deeper than this is within range
  Eigen::Vector3d p_WT_before_{0, 0, 0};
  ContactState state_;
  OffsetTriangle offset_;
  ContactState felt_;   // for a store that lacks packed triangles: the held or fading contact
  ContactState begun_;  // for such a store: the contact at its begin
  TrackerCounters counters_;
  HeldPlane held_;
  SurfacePlace::On held_on_ = SurfacePlace::On::kFace;  // place type that held the tip last
  Eigen::Vector3d along_{0, 0, 0};                      // unit direction of its edge
  Eigen::Vector3d p_WT_held_{0, 0, 0};                  // position of the tip then
  std::uint64_t ticks_held_ = 0;
};

}  // namespace thimble::render
