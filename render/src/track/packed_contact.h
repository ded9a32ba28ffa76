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

/// Finds what the tip touches on a smooth surface of packed triangles: a search while it is free,
/// tracking from offset triangle to offset triangle (offset_triangle.h) while it touches. Where the
/// packed triangles come from is the store's affair; MemoryContact has all of them in memory. The
/// bodies are in packed_contact_steps.h, for who instantiates it.
///
/// Depth and direction are continuous over edges and vertices, since neighbours share offset edges
/// to the bit. Over a crease the tip changes sides at the plane that halves the angle, where both
/// faces measure the same depth [BP 3.1, Fig. 4b], and the direction jumps. Between the two sides
/// of a crease in a hollow the edge or corner itself holds the tip (concave_constraint.h).
///
/// Contact begins where the smooth surface does. On a bulge that is above the triangles, by up to
/// L^2 / 6R for edges of length L on a radius R [PHYSICS 3]: there the depth rises from 0, as
/// long as the store can tell how high the surface rises. In a hollow it is below them: there
/// contact begins and ends at the triangles, softly (depth_below_hollow). So nothing jumps, and
/// no depth is bent towards the triangles as CurvedDepth has to do, which begins at the mesh.
///
/// Where a packed triangle is absent the plane felt last is held (held_plane.h) and the tick is
/// counted. The contact goes on from the last triangle at hand, or from the one nearest to the tip
/// if the way there is not; it ends if there is none within the store's reach. A free tip keeps the
/// path that could not be examined until it is known to be outside where it is; an entry found on
/// the path later counts if it does not come out again, for nobody knows whether the tip went
/// straight.
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
  /// triangles, `kPatchMax` more and two questions to the search.
  const ContactState& update(const driver::DeviceState& state) noexcept;

  /// Returns the result of the last `update`. Real-time: safe.
  const ContactState& state() const noexcept {
    if constexpr (Store::kComplete) return state_;
    return felt_;
  }

  /// Returns the place on the triangles that the tip at `p_WT` (W, m) belongs to
  /// (surface_response.h); that on the felt plane where no packed triangle tells. Precondition: the
  /// last `update` was there and touches. Real-time: safe; some 100 ns.
  SurfaceFoot foot(const Eigen::Vector3d& p_WT) const noexcept;

  const TrackerCounters& counters() const noexcept { return counters_; }
  /// Counts the ticks in which a packed triangle was absent.
  std::uint64_t ticks_held() const noexcept { return ticks_held_; }
  /// Returns where the path begins that the next tick examines if the tip is free (W, m): the last
  /// tip, or an older one where packed triangles were absent. Real-time: safe.
  const Eigen::Vector3d& path_begin() const noexcept { return p_WT_before_; }
  const Store& store() const noexcept { return store_; }  ///< Shows whence packed triangles come.

 private:
  // Surfaces that fit no memory have triangles of 20 um: at 0.5 m/s a tip crosses 60 of them.
  static constexpr std::uint16_t kWalkMax = Store::kComplete ? kHopsMax : 4 * kHopsMax;

  // Says what a tick in contact came to: kUnknown where a packed triangle that decides it is
  // absent.
  using Outcome = Known;

  // The triangles around a corner.
  using Fan = TriangleSet<kPatchMax>;

  // Shows packed triangles to face_above, in steps of the lattice.
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

  // The tick in three pieces, so that the first, all of most ticks, is short and straight; each is
  // made twice for different processors (wide_lanes). The first two tell whether the tick is done.
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
  // What seldom happens is not made twice.
  [[gnu::noinline]] bool begin(const Eigen::Vector3d& p_WT) noexcept;
  bool begin_above(const Eigen::Vector3d& p_WT) noexcept requires TellsRise<Store>;
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
  [[gnu::noinline, gnu::cold]] Outcome hold_in_hollow(const Eigen::Vector3d& p,
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

  // What a tick needs lies together, the rest behind it.
  Store store_;
  bool wide_ = wide_lanes();
  bool steady_ = false;  // in contact, where there is no crease and hops are rare
  bool has_before_ = false;
  bool behind_ = false;     // in contact, held behind a thin part by the active triangle
  bool path_kept_ = false;  // whether the path began before the last tick
  bool above_ = false;      // free, and known to be above the smooth surface
  int recent_hops_ = 0;     // counts up to 3 with ticks that hop, and down with the others
  std::int32_t active_ = -1;
  double deepest_;  // steps: who is in a triangle and no deeper is within range
  Eigen::Vector3d p_WT_before_{0, 0, 0};
  ContactState state_;
  OffsetTriangle offset_;
  ContactState felt_;   // of a store that lacks packed triangles: as held or fading
  ContactState begun_;  // where the contact began, likewise
  TrackerCounters counters_;
  HeldPlane held_;
  SurfacePlace::On hollow_ = SurfacePlace::On::kFace;  // what of a hollow held the tip last,
  Eigen::Vector3d along_{0, 0, 0};                     // the unit direction of its edge,
  Eigen::Vector3d p_WT_hollow_{0, 0, 0};               // and where the tip was then
  std::uint64_t ticks_held_ = 0;
};

}  // namespace thimble::render
