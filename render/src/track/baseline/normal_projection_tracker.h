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

/// Follows the tip by normal projection [BP 4a]: the way the paper looked at and left for edge
/// planes, kept so that the two can be compared.
///
/// A triangle is active while the foot of its face normal through the tip lies in it; then the
/// neighbour over the side that is left most becomes active. Below a convex edge of angle a the
/// prisms overlap, and the depth d jumps by d (1 - cos a) on the way over; below a concave edge
/// they leave a gap, where the least left triangle stays active. Contact ends when the depth turns
/// negative, as in the paper, so it can be lost while the tip is inside. Not for touching things:
/// SurfaceTracker and OffsetTracker have neither fault. A walk that reaches `kHopsMax` continues
/// from the nearest triangle, as OffsetTracker's. Real-time: safe; at worst twice `kHopsMax` cells
/// and one question to the search.
class THIMBLE_EXPORT NormalProjectionTracker {
 public:
  /// Keeps references: mesh and search must outlive the tracker. The search serves walks that reach
  /// `kHopsMax` alone; contact that is lost stays lost.
  NormalProjectionTracker(const ContactMesh& mesh, const ContactSearch& search) noexcept
      : mesh_(&mesh), search_(&search) {}

  /// Makes a triangle active, where the tip has just entered.
  void start(std::int32_t triangle) noexcept { active_ = triangle; }

  /// Follows the tip to `p_WT` (W, m; finite). Precondition: `start` was called and the last step
  /// was touching.
  TrackerStep follow(const Eigen::Vector3d& p_WT) noexcept;

  std::int32_t active() const noexcept { return active_; }

  /// Returns the unit normal of the active triangle, W.
  const Eigen::Vector3d& normal() const noexcept { return mesh_->cell(active_).face.n; }

  /// Finds where on the active triangle the tip belongs (surface_weights.h).
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
