#include "track/offset_tracker.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "mesh/triangle_set.h"
#include "track/concave_constraint.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

// Newton's iteration doubles the digits each round: 2 or 3 rounds from the last tick's depth. The
// maximum seen on a scanned mesh pressed deep was 9; after 12 there is no solution.
constexpr int kRoundsMax = 12;

// Rounding of a weight (2^-53 times products of a few sides) that does not cause a hop. Otherwise
// neighbours whose shared side passes through the tip would alternate.
constexpr double kWeightRounding = 1e-13;

// Faces that lean by more, as a cosine, are the back of a thin part (as in SurfaceTracker).
constexpr double kOppositeFace = -0.25;

Vector3d weighted(const std::array<Vector3d, 3>& corners, const Vector3d& weights) noexcept {
  return weights[0] * corners[0] + weights[1] * corners[1] + weights[2] * corners[2];
}

// Distance of the tip inside each edge, as a share of the triangle's height over it; negative
// beyond the edge.
std::array<double, 3> edge_shares(const ContactMesh& mesh, const SmoothNormals& normals,
                                  std::int32_t triangle, const OffsetTrianglePlace& closest,
                                  const Vector3d& p_WT) noexcept {
  std::array<double, 3> shares{};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t opposite = (k + 2) % 3;
    if (normals.crease(triangle, k) || !closest.found) {
      const Plane plane = mesh.edge_plane(triangle, k);
      const double height = plane.distance(mesh.position(triangle, opposite) - mesh.origin());
      shares[k] = plane.distance(p_WT - mesh.origin()) / std::abs(height);
    } else {
      shares[k] = closest.weights[static_cast<Eigen::Index>(opposite)];
    }
  }
  return shares;
}

}  // namespace

OffsetTrianglePlace find_offset_triangle_place(const ContactMesh& mesh,
                                               const SmoothNormals& normals, std::int32_t triangle,
                                               const Vector3d& p_WT, double depth_near) noexcept {
  const auto& n = normals.corners(triangle);
  const Vector3d& face_n = mesh.cell(triangle).face.n;
  // Relative to a corner: far from the world's origin the differences are still exact.
  const Vector3d& x = mesh.position(triangle, 0);
  const Vector3d side_1 = mesh.position(triangle, 1) - x;
  const Vector3d side_2 = mesh.position(triangle, 2) - x;
  const Vector3d p = p_WT - x;
  OffsetTrianglePlace closest;
  closest.depth = depth_near;
  for (int round = 0; round < kRoundsMax; ++round) {
    const Vector3d e_1 = side_1 - closest.depth * (n[1] - n[0]);
    const Vector3d e_2 = side_2 - closest.depth * (n[2] - n[0]);
    const Vector3d r = p + closest.depth * n[0];
    const Vector3d area = e_1.cross(e_2);
    const double scale = 1 / area.squaredNorm();
    closest.weights[1] = r.cross(e_2).dot(area) * scale;
    closest.weights[2] = e_1.cross(r).dot(area) * scale;
    closest.weights[0] = 1 - closest.weights[1] - closest.weights[2];
    // Moving along the offset plane does not change the height, so only the sinking matters.
    const double sinking = weighted(n, closest.weights).dot(area);
    // A triangle that has shrunk to a point and grown again faces the same way, but its sides are
    // reversed.
    const bool turned_over =
        !(sinking > 0 && area.dot(face_n) > 0 && e_1.dot(side_1) > 0 && e_2.dot(side_2) > 0);
    if (turned_over) return closest;
    const double change = -r.dot(area) / sinking;
    closest.depth += change;
    if (std::abs(change) <= mesh.depth_rounding()) {
      closest.found = true;
      return closest;
    }
  }
  return closest;
}

OffsetTracker::OffsetTracker(const ContactMesh& mesh, const ContactSearch& search,
                             double crease_angle)
    : OffsetTracker(mesh, search, std::make_shared<const SmoothNormals>(mesh, crease_angle)) {}

OffsetTracker::OffsetTracker(const ContactMesh& mesh, const ContactSearch& search,
                             std::shared_ptr<const SmoothNormals> normals)
    : mesh_(&mesh), search_(&search), normals_(std::move(normals)), edge_planes_(mesh, search) {}

void OffsetTracker::start(std::int32_t triangle) noexcept {
  active_ = triangle;
  closest_ = {};
}

void OffsetTracker::hold_by_face(std::int32_t triangle, const Vector3d& p_WT) noexcept {
  start(triangle);
  closest_.depth = mesh_->depth(triangle, p_WT);
  held_.triangle = -1;
  weights_ = within_triangle(projected_weights(*mesh_, triangle, p_WT));
  n_W_ = mesh_->cell(triangle).face.n;
}

TrackerCounters OffsetTracker::counters() const noexcept {
  TrackerCounters sum = edge_planes_.counters();
  sum.cycles += counters_.cycles;
  sum.long_walks += counters_.long_walks;
  sum.found_far += counters_.found_far;
  return sum;
}

TrackerStep OffsetTracker::follow(const Vector3d& p_WT) noexcept {
  TrackerStep step;
  const Walk walked = walk(p_WT);
  step.hops = walked.ended ? walked.hops : walk_on(p_WT, walked);
  // Written so that NaN means no contact.
  if (!(closest_.depth >= 0) && !find_again(p_WT)) return step;
  step.touching = true;
  held_.triangle = -1;
  // No cell holds the tip: usually it is in the gap below a concave crease.
  if (closest_.weights.minCoeff() < -kWeightRounding && hold(p_WT, step)) return step;
  weights_ = within_triangle(closest_.weights);
  const Vector3d sum = weighted(normals_->corners(active_), weights_);
  const double length = sum.norm();
  n_W_ = length > 0 ? Vector3d(sum / length) : mesh_->cell(active_).face.n;
  // The corners sink along unit normals; the interpolated normal between them is shorter.
  step.depth = closest_.found ? closest_.depth * length : closest_.depth;
  return step;
}

bool OffsetTracker::hold(const Vector3d& p_WT, TrackerStep& step) noexcept {
  const GrooveHold hold = hold_in_groove(*mesh_, active_, p_WT);
  if (!hold.holds || !on_concave_crease(*mesh_, *normals_, hold.place)) return false;
  active_ = hold.place.triangle;
  held_ = hold.place;
  step.hops = static_cast<std::uint16_t>(step.hops + hold.hops);
  step.depth = hold.depth;
  n_W_ = hold.n_W;
  weights_ = within_triangle(projected_weights(*mesh_, active_, hold.p_WH));
  closest_.depth = hold.depth;
  return true;
}

OffsetTrianglePlace OffsetTracker::closest_on(std::int32_t triangle,
                                              const Vector3d& p_WT) const noexcept {
  OffsetTrianglePlace closest =
      find_offset_triangle_place(*mesh_, *normals_, triangle, p_WT, closest_.depth);
  // Again from the surface: the depth of one triangle may be beyond the curvature of the next one.
  if (!closest.found) closest = find_offset_triangle_place(*mesh_, *normals_, triangle, p_WT, 0);
  if (!closest.found) {
    closest.weights = edge_plane_weights(*mesh_, triangle, p_WT);
    closest.depth = mesh_->depth(triangle, p_WT);
  }
  return closest;
}

OffsetTracker::Walk OffsetTracker::walk(const Vector3d& p_WT) noexcept {
  TriangleSet<kHopsMax> visited;
  std::int32_t best = active_;
  OffsetTrianglePlace best_place;
  double best_share = -std::numeric_limits<double>::infinity();
  for (std::uint16_t hops = 0; hops < kHopsMax; ++hops) {
    closest_ = closest_on(active_, p_WT);
    const auto shares = edge_shares(*mesh_, *normals_, active_, closest_, p_WT);
    const double least = std::min({shares[0], shares[1], shares[2]});
    if (!(least < -kWeightRounding)) return {.hops = hops, .ended = true, .last = active_};
    if (least > best_share) {
      best = active_;
      best_place = closest_;
      best_share = least;
    }
    visited.add(active_);
    std::int32_t next = -1;
    double next_share = -kWeightRounding;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t neighbour = mesh_->cell(active_).neighbours[k];
      if (shares[k] < next_share && !visited.has(neighbour)) {
        next = neighbour;
        next_share = shares[k];
      }
    }
    if (next < 0) {
      ++counters_.cycles;
      active_ = best;
      closest_ = best_place;
      return {.hops = hops, .ended = true, .last = best};
    }
    active_ = next;
  }
  ++counters_.long_walks;
  const std::int32_t last = std::exchange(active_, best);
  closest_ = best_place;
  return {.hops = kHopsMax, .ended = false, .last = last};
}

// Around a vertex of many faces the violation of the sides rises before it falls. So the best of
// the visited triangles may be the one where the walk began, and the next tick would end there
// again.
std::uint16_t OffsetTracker::walk_on(const Vector3d& p_WT, const Walk& before) noexcept {
  const std::int32_t best = active_;
  const OffsetTrianglePlace best_place = closest_;
  const SurfacePoint hit = search_->closest(p_WT, std::numeric_limits<double>::infinity());
  const bool faces_alike =
      hit.triangle >= 0 &&
      mesh_->cell(hit.triangle).face.n.dot(mesh_->cell(best).face.n) > kOppositeFace;
  // The way around a thin part: the next tick continues from here.
  active_ = faces_alike ? hit.triangle : before.last;
  closest_.depth = best_place.depth;
  if (!faces_alike) {
    closest_ = closest_on(active_, p_WT);
    return before.hops;
  }
  ++counters_.found_far;
  return static_cast<std::uint16_t>(before.hops + walk(p_WT).hops);
}

bool OffsetTracker::find_again(const Vector3d& p_WT) noexcept {
  if (!search_->inside(p_WT)) return false;
  edge_planes_.start(active_);
  const TrackerStep step = edge_planes_.follow(p_WT);
  if (!step.touching) return false;
  active_ = edge_planes_.active();
  closest_.depth = step.depth;
  closest_ = closest_on(active_, p_WT);
  // Inside, but above the smooth cell because its sides lean: on the surface.
  if (!(closest_.depth >= 0)) closest_.depth = 0;
  return true;
}

}  // namespace thimble::render
