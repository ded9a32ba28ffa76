#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "mesh/contact_mesh.h"
#include "mesh/surface_place.h"
#include "mesh/surface_weights.h"
#include "search/contact_search.h"
#include "thimble/driver/export.h"
#include "track/surface_tracker.h"

namespace thimble::render {

/// Tracks the tip by normal projection [BP 4a]: the method that the paper rejected for edge planes,
/// kept for comparison.
///
/// A triangle is active while the projection of the tip along its face normal is in it. Then the
/// neighbour over the most violated side becomes active. Below a convex edge of angle a the prisms
/// overlap, and the depth d jumps by d (1 - cos a) at the change. Below a concave edge they leave a
/// gap, where the least violated triangle stays active. Contact ends when the depth turns negative,
/// as in the paper, so it can be lost while the tip is inside. Not for use in scenes:
/// SurfaceTracker and OffsetTracker have neither fault. A walk that reaches `kHopsMax` continues
/// from the nearest triangle, as in OffsetTracker. Real-time: safe; at worst twice `kHopsMax` cells
/// and one search query.
class THIMBLE_EXPORT NormalProjectionTracker {
 public:
  /// Keeps references: mesh and search must outlive the tracker. The search is used only for walks
  /// that reach `kHopsMax`; contact that is lost stays lost.
  NormalProjectionTracker(const ContactMesh& mesh, const ContactSearch& search) noexcept
      : mesh_(&mesh), search_(&search) {}

  /// Makes the triangle active through which the tip has just entered.
  void start(std::int32_t triangle) noexcept { active_ = triangle; }

  /// Follows the tip to `p_WT` (W, m; finite). Precondition: `start` was called and the last step
  /// was touching.
  TrackerStep follow(const Eigen::Vector3d& p_WT) noexcept;

  std::int32_t active() const noexcept { return active_; }

  /// Returns the unit normal of the active triangle, W.
  const Eigen::Vector3d& normal() const noexcept { return mesh_->cell(active_).face.n; }

  /// Returns the weights of the tip's place on the active triangle (surface_weights.h).
  Eigen::Vector3d weights(const Eigen::Vector3d& p_WT) const noexcept {
    return within_triangle(projected_weights(*mesh_, active_, p_WT));
  }

  /// Returns no place: only faces hold a tip here.
  static SurfacePlace held() noexcept { return {}; }

  const TrackerCounters& counters() const noexcept { return counters_; }

 private:
  std::uint16_t walk(const Eigen::Vector3d& p_WT) noexcept;
  std::uint16_t walk_on(const Eigen::Vector3d& p_WT, std::int32_t before) noexcept;

  const ContactMesh* mesh_;
  const ContactSearch* search_;
  std::int32_t active_ = -1;
  TrackerCounters counters_;
};

}  // namespace thimble::render
