#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>

#include "mesh/contact_mesh.h"
#include "mesh/smooth_normals.h"
#include "mesh/surface_place.h"
#include "mesh/surface_weights.h"
#include "mesh/triangle_place.h"
#include "search/contact_search.h"
#include "thimble/driver/export.h"
#include "track/surface_tracker.h"

namespace thimble::render {

/// Place of a tip on a triangle whose corners sink along their normals.
struct OffsetTrianglePlace {
  Eigen::Vector3d weights{0, 0, 0};  ///< Weights of the corners; negative beyond a side.
  double depth = 0;                  ///< Sinking of the corners, m; negative outside.
  bool found = false;                ///< False if the offset triangle has turned over: too deep.
};

/// Finds weights w and depth d with p = sum of w_k (x_k - d n_k), where x are the corners and n
/// their normals: the place of the tip (W, m) on the triangle that is sunk by d.
///
///       x_0 ---- q ----- x_1      surface; q = sum w_k x_k
///        |       |        |       the three ways down are straight
///       y_0 ---- p ----- y_1      sunk by d; y = x - d n
///
/// Newton's iteration in d only, from `depth_near`. For given d the offset triangle is plane, and
/// the slope of the height above it is known in closed form. Real-time: safe; 2 or 3 rounds from a
/// near depth, at worst 12.
OffsetTrianglePlace find_offset_triangle_place(const ContactMesh& mesh,
                                               const SmoothNormals& normals, std::int32_t triangle,
                                               const Eigen::Vector3d& p_WT,
                                               double depth_near) noexcept;

/// Tracks the tip over a smooth surface, with depth and direction continuous over edges and
/// vertices at every depth up to the surface's radius of curvature.
///
/// The cell of a triangle is the volume swept when its corners sink along their normals. Neighbours
/// share a bit-identical swept side, so cells neither overlap nor leave gaps, even at vertices,
/// unlike those of edge planes. The normal is the weighted mean of the corner normals, the proxy is
/// the point q of the surface, and the depth is the distance from it. At creases there is one
/// normal on each side, and the edge plane between the two faces decides [BP 4b]. Between the cells
/// of a concave crease the edge or corner itself holds the tip (concave_constraint.h).
///
/// Where an offset triangle has turned over, the edge planes replace it. A walk that reaches
/// `kHopsMax`, as around a vertex of hundreds of faces, continues from the nearest triangle that
/// the search returns. It does not if that triangle faces the other way, like the back of a thin
/// part. If the depth turns negative while the tip is inside, SurfaceTracker finds the contact
/// again. Deterministic. All but the constructors is Real-time: safe; usually one or two places per
/// tick, at worst twice `kHopsMax`, one search query, and the cost of SurfaceTracker.
class THIMBLE_EXPORT OffsetTracker {
 public:
  /// Keeps references: mesh and search must outlive the tracker.
  /// Real-time: never from the servo thread.
  OffsetTracker(const ContactMesh& mesh, const ContactSearch& search,
                double crease_angle = kCreaseAngle);

  /// Takes normals already computed for the same mesh. Real-time: never from the servo thread.
  OffsetTracker(const ContactMesh& mesh, const ContactSearch& search,
                std::shared_ptr<const SmoothNormals> normals);

  /// Makes the triangle active through which the tip has just entered.
  void start(std::int32_t triangle) noexcept;

  /// Makes a triangle active whose face holds the tip at `p_WT` (W, m), although none of its cells
  /// does.
  void hold_by_face(std::int32_t triangle, const Eigen::Vector3d& p_WT) noexcept;

  /// Follows the tip to `p_WT` (W, m; finite). Precondition: `start` was called and the last step
  /// was touching.
  TrackerStep follow(const Eigen::Vector3d& p_WT) noexcept;

  std::int32_t active() const noexcept { return active_; }

  /// Returns the unit normal at the tip's place on the surface, W, as of the last step.
  const Eigen::Vector3d& normal() const noexcept { return n_W_; }

  /// Returns the concave edge or corner that holds the tip as of the last step; its triangle is -1
  /// if a smooth cell holds it.
  const SurfacePlace& held() const noexcept { return held_; }

  /// Returns the weights of the tip's place on the active triangle (surface_weights.h), as of the
  /// last step.
  const Eigen::Vector3d& weights(const Eigen::Vector3d&) const noexcept { return weights_; }

  /// Returns the place on the active triangle of the tip at `p_WT` (W, m), as of the last step.
  TrianglePlace closest(const Eigen::Vector3d& p_WT) const noexcept {
    return closest_.found
               ? offset_triangle_place(*mesh_, *normals_, active_, weights_, closest_.depth)
               : edge_plane_place(*mesh_, active_, p_WT);
  }

  /// Returns minus the gradient of the last step's depth by the tip's position, for its `foot`.
  /// Where the corners have not sunk, this is the normal of the face, edge or corner that holds the
  /// tip.
  Eigen::Vector3d fall(const TrianglePlace& closest) const noexcept {
    if (held_.triangle >= 0) return n_W_;
    if (!closest_.found) return mesh_->cell(active_).face.n;
    return -offset_depth_slope(normals_->corners(active_), closest, closest_.depth);
  }

  TrackerCounters counters() const noexcept;

  /// Returns the normals of the mesh, for stages that share them.
  const std::shared_ptr<const SmoothNormals>& smooth_normals() const noexcept { return normals_; }

 private:
  OffsetTrianglePlace closest_on(std::int32_t triangle, const Eigen::Vector3d& p_WT) const noexcept;
  /// Result of a walk.
  struct Walk {
    std::uint16_t hops = 0;
    bool ended = false;      // within kHopsMax: a cell holds the tip, or none nearby does
    std::int32_t last = -1;  // triangle that was reached
  };
  Walk walk(const Eigen::Vector3d& p_WT) noexcept;
  std::uint16_t walk_on(const Eigen::Vector3d& p_WT, const Walk& before) noexcept;
  bool find_again(const Eigen::Vector3d& p_WT) noexcept;
  bool hold(const Eigen::Vector3d& p_WT, TrackerStep& step) noexcept;

  const ContactMesh* mesh_;
  const ContactSearch* search_;
  std::shared_ptr<const SmoothNormals> normals_;
  SurfaceTracker edge_planes_;
  std::int32_t active_ = -1;
  SurfacePlace held_;
  OffsetTrianglePlace closest_;
  Eigen::Vector3d weights_{0, 0, 0};
  Eigen::Vector3d n_W_{0, 0, 0};
  TrackerCounters counters_;
};

}  // namespace thimble::render
