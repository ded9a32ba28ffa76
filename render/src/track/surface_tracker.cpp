#include "track/surface_tracker.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "mesh/closest_point.h"
#include "mesh/triangle_set.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

// A tip pressed straight down sinks by what it moves: twice as much cannot be rounding.
constexpr double kRiseSquaredMax = 4;

// Is an edge plane with the tip's distance to it; negative means violated.
struct WorstEdge {
  std::size_t edge = 0;
  double distance = 0;
};

WorstEdge worst_edge(const TriangleCell& cell, const Vector3d& p) noexcept {
  const double d0 = cell.edges[0].distance(p);
  const double d1 = cell.edges[1].distance(p);
  const double d2 = cell.edges[2].distance(p);
  WorstEdge worst{0, d0};
  if (d1 < worst.distance) worst = {1, d1};
  if (d2 < worst.distance) worst = {2, d2};
  return worst;
}

// Squared distances this near to each other, as a share, are those of a common edge or vertex:
// which is smaller is rounding, and must not decide. A mesh 1e4 sizes from the origin is exact to
// 1e-12.
constexpr double kTie = 1e-6;

// Keeps the triangle nearest to the tip among those that have the tip below them. At an edge or
// vertex several are equally near: there the deepest one tells inside from outside.
class NearestAbove {
 public:
  NearestAbove(const ContactMesh& mesh, const Vector3d& p_WT) noexcept : mesh_(mesh), p_WT_(p_WT) {}

  void consider(std::int32_t triangle) noexcept {
    const double depth = mesh_.depth(triangle, p_WT_);
    if (!(depth >= -mesh_.depth_rounding())) return;
    const Vector3d nearest =
        closest_point(p_WT_, mesh_.position(triangle, 0), mesh_.position(triangle, 1),
                      mesh_.position(triangle, 2));
    const double distance = (nearest - p_WT_).squaredNorm();
    const bool tied = distance <= (1 + kTie) * distance_ && distance_ <= (1 + kTie) * distance;
    if (tied ? depth > depth_ : distance < distance_) {
      triangle_ = triangle;
      distance_ = distance;
      depth_ = depth;
    }
  }

  std::int32_t triangle() const noexcept { return triangle_; }

 private:
  const ContactMesh& mesh_;
  const Vector3d& p_WT_;
  std::int32_t triangle_ = -1;
  double distance_ = std::numeric_limits<double>::infinity();
  double depth_ = 0;
};

}  // namespace

TrackerStep SurfaceTracker::follow(const Vector3d& p_WT) noexcept {
  const std::int32_t before = active_;
  TrackerStep step;
  step.hops = walk(p_WT - mesh_->origin());
  double depth = mesh_->depth(active_, p_WT);
  if (step.hops > 0 && too_deep(p_WT, before, depth)) depth = reject_hop(p_WT, before, depth);
  if (!(depth >= 0)) {
    if (!search_->inside(p_WT)) return step;
    // Inside, with the plane above by no more than rounding: the tip is on the surface.
    if (depth < -mesh_->depth_rounding()) {
      if (find_near(p_WT, before)) {
        ++counters_.found_near;
      } else {
        reacquire(p_WT);
        ++counters_.found_far;
      }
      depth = mesh_->depth(active_, p_WT);
    }
  }
  step.touching = true;
  step.depth = std::max(depth, 0.0);
  has_before_ = true;
  p_WT_before_ = p_WT;
  depth_before_ = step.depth;
  return step;
}

double SurfaceTracker::reject_hop(const Vector3d& p_WT, std::int32_t before,
                                  double depth_walked) noexcept {
  // Around the triangle left only: the other end of the walk is what is in doubt.
  const std::int32_t walked_to = std::exchange(active_, before);
  double depth = find_near(p_WT, before) ? mesh_->depth(active_, p_WT) : depth_walked;
  if (!(depth < depth_walked)) {
    active_ = walked_to;
    return depth_walked;
  }
  ++counters_.called_back;
  ++counters_.found_near;
  return depth;
}

bool SurfaceTracker::too_deep(const Vector3d& p_WT, std::int32_t before,
                              double depth) const noexcept {
  // On entering, the triangle that was entered tells how deep the tip may be at least.
  const double rise =
      depth - (has_before_ ? depth_before_ : std::max(mesh_->depth(before, p_WT), 0.0));
  const double moved_squared = has_before_ ? (p_WT - p_WT_before_).squaredNorm() : 0;
  return rise > mesh_->depth_rounding() && rise * rise > kRiseSquaredMax * moved_squared;
}

std::uint16_t SurfaceTracker::walk(const Vector3d& p) noexcept {
  // Nearly every tick ends here or one hop on, without the memory that a long walk needs.
  if (!(worst_edge(mesh_->cell(active_), p).distance < 0)) return 0;
  return settle(p);
}

std::uint16_t SurfaceTracker::settle(const Vector3d& p) noexcept {
  TriangleSet<kHopsMax> visited;
  std::int32_t best = active_;
  double best_distance = -std::numeric_limits<double>::infinity();
  for (std::uint16_t hops = 0; hops < kHopsMax; ++hops) {
    const TriangleCell& cell = mesh_->cell(active_);
    const WorstEdge worst = worst_edge(cell, p);
    if (!(worst.distance < 0)) return hops;
    if (worst.distance > best_distance) {
      best = active_;
      best_distance = worst.distance;
    }
    visited.add(active_);
    const std::int32_t next = cell.neighbours[worst.edge];
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

bool SurfaceTracker::find_near(const Vector3d& p_WT, std::int32_t before) noexcept {
  // Ring by ring over shared vertices, from where the walk ended and from where it began: a far
  // side is reached only around an edge, never through the material.
  TriangleSet<kPatchMax> patch;
  patch.add(active_);
  patch.add(before);
  NearestAbove nearest(*mesh_, p_WT);
  for (std::size_t i = 0; i < patch.size(); ++i) {
    const std::int32_t triangle = patch[i];
    nearest.consider(triangle);
    for (const std::int32_t vertex : mesh_->corners(triangle)) {
      if (patch.full()) break;
      for (const std::int32_t around : mesh_->fan(vertex)) {
        if (patch.full()) break;
        patch.add(around);
      }
    }
  }
  if (nearest.triangle() < 0) return false;
  active_ = nearest.triangle();
  return true;
}

void SurfaceTracker::reacquire(const Vector3d& p_WT) noexcept {
  const SurfacePoint hit = search_->closest(p_WT, std::numeric_limits<double>::infinity());
  if (hit.triangle < 0) return;
  // Where the nearest point lies on an edge or at a vertex, one of the triangles there has a tip
  // that is inside below it, but not every one of them.
  NearestAbove nearest(*mesh_, p_WT);
  for (const std::int32_t vertex : mesh_->corners(hit.triangle)) {
    for (const std::int32_t t : mesh_->fan(vertex)) nearest.consider(t);
  }
  active_ = nearest.triangle() >= 0 ? nearest.triangle() : hit.triangle;
}

}  // namespace thimble::render
