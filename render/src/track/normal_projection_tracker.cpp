#include "track/normal_projection_tracker.h"

#include <limits>
#include "mesh/triangle_set.h"

namespace thimble::render {

using Eigen::Vector3d;

TrackerStep NormalProjectionTracker::follow(const Vector3d& p_WT) noexcept {
  TrackerStep step;
  step.hops = walk(p_WT);
  const double depth = mesh_->depth(active_, p_WT);
  step.touching = depth >= 0;
  if (step.touching) step.depth = depth;
  return step;
}

std::uint16_t NormalProjectionTracker::walk(const Vector3d& p_WT) noexcept {
  TriangleSet<kHopsMax> visited;
  std::int32_t best = active_;
  double best_weight = -std::numeric_limits<double>::infinity();
  for (std::uint16_t hops = 0; hops < kHopsMax; ++hops) {
    Eigen::Index corner = 0;
    const double least = projected_weights(*mesh_, active_, p_WT).minCoeff(&corner);
    // Written so that NaN stays where it is.
    if (!(least < 0)) return hops;
    if (least > best_weight) {
      best = active_;
      best_weight = least;
    }
    visited.add(active_);
    // The side opposite corner k is the edge from corner k + 1.
    const std::int32_t next =
        mesh_->cell(active_).neighbours[(static_cast<std::size_t>(corner) + 1) % 3];
    if (visited.has(next)) {
      ++counters_.cycles;
      active_ = best;
      return hops;
    }
    active_ = next;
  }
  ++counters_.long_walks;
  active_ = best;
  return kHopsMax;
}

}  // namespace thimble::render
