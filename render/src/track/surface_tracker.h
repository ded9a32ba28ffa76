#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>

#include "mesh/contact_mesh.h"
#include "mesh/surface_place.h"
#include "mesh/surface_weights.h"
#include "mesh/triangle_place.h"
#include "search/contact_search.h"
#include "thimble/driver/export.h"

namespace thimble::render {

/// Maximum number of triangles a tracker crosses in one tick. At 2 m/s and 1 kHz the tip moves 2
/// mm; over triangles of 0.3 mm that is 7 hops [PHYSICS 3: vT/L]. A walk around a vertex of valence
/// 64 needs 32. Reaching the bound is counted.
inline constexpr std::uint16_t kHopsMax = 64;

/// Maximum number of triangles examined to find a contact again nearby: the third ring around a
/// triangle of a regular mesh has about 75.
inline constexpr std::int32_t kPatchMax = 128;

/// Counts of cases that a plain walk cannot decide.
struct TrackerCounters {
  std::uint64_t cycles = 0;       ///< Walks that came back to a triangle: no cell holds the tip.
  std::uint64_t long_walks = 0;   ///< Walks that reached `kHopsMax`.
  std::uint64_t found_near = 0;   ///< Contact found again over the surface nearby.
  std::uint64_t called_back = 0;  ///< Part of `found_near`: walks that ended too deep.
  std::uint64_t found_far = 0;    ///< Contact found again only by a search query.
  std::uint64_t nearer = 0;       ///< Faces nearby that were nearer than the cell's own.
};

/// Position of the tip relative to the surface after one tick.
struct TrackerStep {
  bool touching = false;   ///< Whether the tip still touches.
  double depth = 0;        ///< Depth below the active triangle's plane, m; at least 0 if touching.
  std::uint16_t hops = 0;  ///< Number of edge planes crossed.
};

/// Tracks the tip over the surface of a mesh from triangle to triangle [BP 3.1].
///
/// If the tip is outside edge planes of the active triangle, it hops to the neighbour behind the
/// plane it violates most, until a cell holds it. Contact stays while the depth is positive, even
/// when the tip has come out at the back of a thin part: this is the purpose of the memory.
///
/// Near vertices the cells overlap or leave gaps. If a walk would come back to a triangle, or gets
/// too long, the least violated visited triangle stays active. Cells of distant faces overlap too.
/// If a walk has made the tip deeper by more than twice its move, it has entered such a cell. Then
/// the nearest triangle over the surface that has the tip below it becomes active instead, if it is
/// less deep. If the depth turns negative while the tip is still inside, another triangle becomes
/// active: the nearest one that can be reached over the surface and has the tip below it. So
/// contact is never lost inside. Next to a face, over a concave edge, that face would push the tip
/// across the edge, and the next face would push it back. There two faces hold it, or three or more
/// in a corner, at the closest point of edge or corner (concave_constraint.h). Deterministic. All
/// but the constructor is Real-time: safe; usually one cell per tick, at worst `kHopsMax` cells,
/// twice `kPatchMax` triangles and two search queries.
class THIMBLE_EXPORT SurfaceTracker {
 public:
  /// Keeps references: mesh and search must outlive the tracker.
  SurfaceTracker(const ContactMesh& mesh, const ContactSearch& search) noexcept
      : mesh_(&mesh), search_(&search) {}

  /// Makes the triangle active through which the tip has just entered.
  void start(std::int32_t triangle) noexcept {
    active_ = triangle;
    looked_ = -1;
    held_ = {};
    has_before_ = false;
  }

  /// Makes a triangle active whose face holds the tip, although none of its cells does.
  void hold_by_face(std::int32_t triangle, const Eigen::Vector3d&) noexcept { start(triangle); }

  /// Follows the tip to `p_WT` (W, m; finite). Precondition: `start` was called and the last step
  /// was touching.
  TrackerStep follow(const Eigen::Vector3d& p_WT) noexcept;

  /// Returns the active triangle.
  std::int32_t active() const noexcept { return active_; }

  /// Returns the unit normal of the active triangle, or the direction to the concave edge or corner
  /// that holds the tip; W.
  const Eigen::Vector3d& normal() const noexcept {
    return held_.triangle < 0 ? mesh_->cell(active_).face.n : n_W_;
  }

  /// Returns the edge or corner that holds the tip as of the last step; its triangle is -1 if a
  /// face holds it.
  const SurfacePlace& held() const noexcept { return held_; }

  /// Returns the weights of the tip's place on the active triangle (surface_weights.h).
  Eigen::Vector3d weights(const Eigen::Vector3d& p_WT) const noexcept {
    return within_triangle(edge_plane_weights(*mesh_, active_, p_WT));
  }

  /// Returns the place on the active triangle of the tip at `p_WT` (W, m).
  TrianglePlace closest(const Eigen::Vector3d& p_WT) const noexcept {
    return edge_plane_place(*mesh_, active_, p_WT);
  }

  /// Returns minus the gradient of the depth by the tip's position: the normal.
  Eigen::Vector3d fall(const TrianglePlace&) const noexcept { return normal(); }

  const TrackerCounters& counters() const noexcept { return counters_; }

 private:
  // Signed distance of the tip from the edge planes of a cell, m, positive inside: the least, which
  // is the plane it violates most (below 0) or is nearest to.
  struct EdgeDistances {
    std::size_t worst = 0;
    double least = 0;
  };
  EdgeDistances edge_distances(std::int32_t triangle, const Eigen::Vector3d& p) noexcept;
  // A function of its own: ticks are shorter where the mesh stores its planes.
  [[gnu::noinline]] const std::array<Plane, 3>& made_edge_planes(std::int32_t triangle) noexcept;
  // No distance changes by more than the tip moves. So nothing needs to be examined until the tip
  // has moved half of the distance by which the nearest other face is farther away.
  bool is_quiet(const Eigen::Vector3d& p_WT) const noexcept {
    return looked_ == active_ && (p_WT - p_WT_looked_).squaredNorm() < quiet_squared_ &&
           !mesh_->moved();
  }
  bool search_near(const Eigen::Vector3d& p_WT, TrackerStep& step) noexcept;
  void hold(const Eigen::Vector3d& p_WT, TrackerStep& step) noexcept;
  std::uint16_t walk(const Eigen::Vector3d& p, EdgeDistances& edges) noexcept;
  std::uint16_t settle(const Eigen::Vector3d& p, EdgeDistances& edges) noexcept;
  bool find_near(const Eigen::Vector3d& p_WT, std::int32_t before) noexcept;
  void reacquire(const Eigen::Vector3d& p_WT) noexcept;
  double reject_hop(const Eigen::Vector3d& p_WT, std::int32_t before, double depth_walked) noexcept;
  bool too_deep(const Eigen::Vector3d& p_WT, std::int32_t before, double depth) const noexcept;

  const ContactMesh* mesh_;
  const ContactSearch* search_;
  std::int32_t active_ = -1;
  SurfacePlace held_;
  Eigen::Vector3d n_W_{0, 0, 0};  // direction to the edge or corner that holds the tip
  bool has_before_ = false;       // whether the next two members are those of the last tick
  Eigen::Vector3d p_WT_before_{0, 0, 0};
  double depth_before_ = 0;
  std::int32_t looked_ = -1;  // triangle whose surroundings were examined last, and the tip then
  Eigen::Vector3d p_WT_looked_{0, 0, 0};
  double quiet_squared_ = 0;     // squared path within which no other face is nearer, m^2
  std::int32_t planes_of_ = -1;  // of the planes computed last, where the mesh stores none
  std::array<Plane, 3> planes_;
  TrackerCounters counters_;
};

}  // namespace thimble::render
