#include "track/surface_tracker.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "mesh/closest_point.h"
#include "mesh/triangle_closest_point.h"
#include "mesh/triangle_set.h"
#include "track/concave_constraint.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

// A tip pressed straight down sinks by its move: twice as much cannot be rounding.
constexpr double kRiseSquaredMax = 4;

// Faces nearby that lean by less are not examined: the wrong one costs 2 % of the depth. Sine of
// half the angle, in TriangleCell's unit, and cosine of the angle: 11.5 degrees. [chosen]
constexpr std::uint16_t kLean = 6554;
constexpr double kNearlyFlat = 0.98;

// Faces that lean by more, as a cosine, are the back of a thin part. They become active only over
// edges. 104 degrees, so that the walls of a block are all included. [chosen]
constexpr double kOppositeSide = -0.25;

// Ratio by which the holding point is farther away than the plane of the face. [chosen]
constexpr double kBeyondPlane = 1.1;

// Each round leads to a nearer face; the next tick continues.
constexpr int kRoundsAround = 4;

// Squared distances that differ by less than this share belong to a common edge or vertex. Their
// order is rounding and must not decide. A mesh 1e4 sizes from the origin is exact to 1e-12.
constexpr double kTie = 1e-6;

// Keeps the triangle nearest to the tip among those that have the tip below them. At an edge or
// vertex several are equally near: there the deepest one separates inside from outside.
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

const std::array<Plane, 3>& SurfaceTracker::made_edge_planes(std::int32_t triangle) noexcept {
  if (planes_of_ != triangle) {
    for (std::size_t k = 0; k < 3; ++k) planes_[k] = mesh_->edge_plane(triangle, k);
    planes_of_ = triangle;
  }
  return planes_;
}

inline SurfaceTracker::EdgeDistances SurfaceTracker::edge_distances(std::int32_t triangle,
                                                                    const Vector3d& p) noexcept {
  const std::array<Plane, 3>& edge =
      mesh_->keeps_planes() ? mesh_->edge_planes(triangle) : made_edge_planes(triangle);
  const double d0 = edge[0].distance(p);
  const double d1 = edge[1].distance(p);
  const double d2 = edge[2].distance(p);
  EdgeDistances found{.worst = 0, .least = d0};
  if (d1 < found.least) {
    found.worst = 1;
    found.least = d1;
  }
  if (d2 < found.least) {
    found.worst = 2;
    found.least = d2;
  }
  return found;
}

TrackerStep SurfaceTracker::follow(const Vector3d& p_WT) noexcept {
  const std::int32_t before = active_;
  const Vector3d p = p_WT - mesh_->origin();
  TrackerStep step;
  EdgeDistances edges;
  step.hops = walk(p, edges);
  const bool far = step.hops >= kHopsMax;
  if (far) [[unlikely]] {
    // So far that the triangles in between give no information.
    if (!search_->inside(p_WT)) return step;
    reacquire(p_WT);
    ++counters_.found_far;
    edges = edge_distances(active_, p);
  }
  double depth = mesh_->depth(active_, p_WT);
  if (step.hops > 0 && !far && too_deep(p_WT, before, depth)) {
    depth = reject_hop(p_WT, before, depth);
    edges = edge_distances(active_, p);
  }
  if (!(depth >= 0)) {
    if (!search_->inside(p_WT)) return step;
    // Inside, with the plane above only by rounding: the tip is on the surface.
    if (depth < -mesh_->depth_rounding()) {
      if (find_near(p_WT, before)) {
        ++counters_.found_near;
      } else {
        reacquire(p_WT);
        ++counters_.found_far;
      }
      depth = mesh_->depth(active_, p_WT);
      edges = edge_distances(active_, p);
    }
  }
  step.touching = true;
  step.depth = std::max(depth, 0.0);
  held_.triangle = -1;
  if ((mesh_->cell(active_).around > kLean || mesh_->moved()) &&
      !(edges.least >= 0 && is_quiet(p_WT)) && search_near(p_WT, step)) {
    edges = edge_distances(active_, p);
  }
  // Next to a concave edge, the face is not the only constraint.
  const TriangleCell& cell = mesh_->cell(active_);
  if (cell.concave > 0 && edges.least < cell.concave_reach(step.depth)) {
    const double plane = step.depth;
    hold(p_WT, step);
    // Farther than the plane: other faces may be nearer that were not nearer than the plane.
    if (held_.triangle >= 0 && step.depth > kBeyondPlane * plane && search_near(p_WT, step)) {
      hold(p_WT, step);
    }
  }
  has_before_ = true;
  p_WT_before_ = p_WT;
  depth_before_ = step.depth;
  return step;
}

// Cells end only at the planes of their own edges. So around a sharp corner, or a ridge of small
// triangles, a tip may be in the cell of one face while another is nearer. The nearer face becomes
// active, unless it faces away from the entered one.
bool SurfaceTracker::search_near(const Vector3d& p_WT, TrackerStep& step) noexcept {
  bool moved = false;
  double quiet = 0;
  for (int round = 0; round < kRoundsAround; ++round) {
    const TriangleCell& cell = mesh_->cell(active_);
    std::int32_t best = -1;
    double nearest = step.depth;
    quiet = std::numeric_limits<double>::infinity();
    for (const std::int32_t vertex : mesh_->corners(active_)) {
      const auto fan = mesh_->fan(vertex);
      if (fan.size() > TriangleCell::kFanMax) continue;
      for (const std::int32_t t : fan) {
        const Vector3d& n = mesh_->cell(t).face.n;
        const double lean = n.dot(cell.face.n);
        if (!(lean < kNearlyFlat && lean > kOppositeSide)) continue;
        // No point of a triangle is nearer than its plane.
        const double depth = mesh_->depth(t, p_WT);
        double farther = depth < 0 ? -2 * depth : depth - step.depth;
        if (depth >= 0 && depth < nearest) {
          const double distance = std::sqrt(closest_on(*mesh_, t, p_WT).distance_squared);
          farther = distance - step.depth;
          // The first of several equally near faces, so that rounding does not decide.
          if (distance < nearest * (1 - kTie)) {
            best = t;
            nearest = distance;
          }
        }
        const auto& beside = cell.neighbours;  // separated by their edge planes
        if (t != beside[0] && t != beside[1] && t != beside[2]) quiet = std::min(quiet, farther);
      }
    }
    if (best < 0) break;
    moved = true;
    active_ = best;
    ++step.hops;
    ++counters_.nearer;
    step.depth = std::max(mesh_->depth(best, p_WT), 0.0);
    quiet = 0;
  }
  looked_ = held_.triangle < 0 ? active_ : -1;
  p_WT_looked_ = p_WT;
  quiet_squared_ = quiet > 0 ? quiet * quiet / 4 : 0;
  return moved;
}

// The tip is next to the active face, over a concave edge, or in no cell.
void SurfaceTracker::hold(const Vector3d& p_WT, TrackerStep& step) noexcept {
  held_.triangle = -1;
  const GrooveHold hold = hold_in_groove(*mesh_, active_, p_WT);
  if (!hold.holds) return;
  // The distance of the closest point nearby changes by no more than the tip moves. Where surfaces
  // fold over themselves, the way to it may end early, far away; then the face continues to hold.
  if (has_before_ && too_deep(p_WT, active_, hold.depth)) return;
  counters_.nearer += active_ != hold.place.triangle;
  active_ = hold.place.triangle;
  step.hops = static_cast<std::uint16_t>(step.hops + hold.hops);
  step.depth = hold.depth;
  if (hold.place.on == SurfacePlace::On::kFace) return;
  held_ = hold.place;
  n_W_ = hold.n_W;
}

double SurfaceTracker::reject_hop(const Vector3d& p_WT, std::int32_t before,
                                  double depth_walked) noexcept {
  // Only around the triangle that was left: the other end of the walk is in doubt.
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
  // On entering, the entered triangle gives the minimum depth of the tip.
  const double rise =
      depth - (has_before_ ? depth_before_ : std::max(mesh_->depth(before, p_WT), 0.0));
  const double moved_squared = has_before_ ? (p_WT - p_WT_before_).squaredNorm() : 0;
  return rise > mesh_->depth_rounding() && rise * rise > kRiseSquaredMax * moved_squared;
}

std::uint16_t SurfaceTracker::walk(const Vector3d& p, EdgeDistances& edges) noexcept {
  // Nearly every tick ends here or one hop later, without the memory that a long walk needs.
  edges = edge_distances(active_, p);
  if (!(edges.least < 0)) return 0;
  return settle(p, edges);
}

std::uint16_t SurfaceTracker::settle(const Vector3d& p, EdgeDistances& edges) noexcept {
  TriangleSet<kHopsMax> visited;
  std::int32_t best = active_;
  EdgeDistances best_edges;
  best_edges.least = -std::numeric_limits<double>::infinity();
  for (std::uint16_t hops = 0; hops < kHopsMax; ++hops) {
    const TriangleCell& cell = mesh_->cell(active_);
    edges = edge_distances(active_, p);
    if (!(edges.least < 0)) return hops;
    if (edges.least > best_edges.least) {
      best = active_;
      best_edges = edges;
    }
    visited.add(active_);
    const std::int32_t next = cell.neighbours[edges.worst];
    if (visited.has(next)) {
      ++counters_.cycles;
      active_ = best;
      edges = best_edges;
      return hops;
    }
    active_ = next;
  }
  ++counters_.long_walks;
  active_ = best;
  edges = best_edges;
  return kHopsMax;
}

bool SurfaceTracker::find_near(const Vector3d& p_WT, std::int32_t before) noexcept {
  // Ring by ring over shared vertices, from the end and from the begin of the walk: a far side is
  // reached only around an edge, never through the material.
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
  // If the closest point is on an edge or at a vertex, at least one of the triangles there has a
  // tip that is inside below it, but not every one.
  NearestAbove nearest(*mesh_, p_WT);
  for (const std::int32_t vertex : mesh_->corners(hit.triangle)) {
    for (const std::int32_t t : mesh_->fan(vertex)) nearest.consider(t);
  }
  active_ = nearest.triangle() >= 0 ? nearest.triangle() : hit.triangle;
}

}  // namespace thimble::render
