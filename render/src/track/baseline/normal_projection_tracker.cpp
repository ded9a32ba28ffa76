#include "track/baseline/normal_projection_tracker.h"

#include <limits>
#include "mesh/triangle_set.h"

namespace thimble::render {

using Eigen::Vector3d;

namespace {

// Faces that lean by more, as a cosine, are the back of a thin part (as in SurfaceTracker).
constexpr double kBackOfThinPart = -0.25;

}  // namespace

TrackerStep NormalProjectionTracker::follow(const Vector3d& p_WT) noexcept {
  TrackerStep step;
  const std::int32_t before = active_;
  step.hops = walk(p_WT);
  if (step.hops == kHopsMax) {
    step.hops = static_cast<std::uint16_t>(step.hops + walk_on(p_WT, before));
  }
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
    // Written so that NaN stays in the triangle.
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
  return kHopsMax;
}

// Around a vertex of many faces the best of the visited triangles may be the one where the walk
// began, and each tick would end there again (as in OffsetTracker).
std::uint16_t NormalProjectionTracker::walk_on(const Vector3d& p_WT, std::int32_t before) noexcept {
  const SurfacePoint hit = search_->closest(p_WT, std::numeric_limits<double>::infinity());
  if (hit.triangle < 0 ||
      !(mesh_->cell(hit.triangle).face.n.dot(mesh_->cell(before).face.n) > kBackOfThinPart)) {
    return 0;
  }
  active_ = hit.triangle;
  ++counters_.found_far;
  const std::uint16_t hops = walk(p_WT);
  // Next to the vertex itself many are equally near.
  if (hops == kHopsMax) active_ = hit.triangle;
  return hops;
}

}  // namespace thimble::render
