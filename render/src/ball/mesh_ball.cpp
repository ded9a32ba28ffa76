#include "ball/mesh_ball.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "mesh/triangle_closest_point.h"

namespace thimble::render {

using Eigen::Vector3d;

namespace {

// Reach of a new neighbourhood, in steps of the ball and in radii. A large one is looked up
// seldom, and lists many triangles. [chosen]
constexpr double kReachSteps = 6;
constexpr double kReachRadii = 0.03125;

// Reach of the half-spaces of one step, in steps. [chosen]
constexpr double kReachRound = 1.5;

constexpr double kInfinite = std::numeric_limits<double>::infinity();

}  // namespace

MeshBall::MeshBall(std::shared_ptr<const TriangleTree> tree,
                   std::shared_ptr<const ContactSearch> search, double radius) noexcept
    : tree_(std::move(tree)),
      search_(std::move(search)),
      radius_(radius),
      rounding_(mesh().depth_rounding() + 16 * 0x1p-53 * radius) {}

SolidBox MeshBall::box() const noexcept {
  return {mesh().box_min().array() - radius_, mesh().box_max().array() + radius_};
}

BallFeature MeshBall::feature(std::int32_t triangle, const Vector3d& q) const noexcept {
  const TriangleClosestPoint closest = closest_on(mesh(), triangle, q);
  BallFeature found{.id = triangle, .p_W = closest.p_OP};
  const Vector3d from = q - closest.p_OP;
  const double distance = std::sqrt(closest.distance_squared);
  found.gap = distance - radius_;
  found.n_W = from / distance;
  const std::size_t k = closest.place.k;
  switch (closest.place.on) {
    case SurfacePlace::On::kFace: {
      // Its normal is better known than the difference of two points.
      const Vector3d& n = mesh().cell(triangle).face.n;
      const double height = n.dot(from);
      // Of a triangle without area, and of one that is seen from the edge, it is not.
      if (std::abs(std::abs(height) - distance) > 1e-9 * distance) break;
      found.n_W = height > 0 ? n : Vector3d(-n);
      found.gap = std::abs(height) - radius_;
      break;
    }
    case SurfacePlace::On::kEdge:
      found.kind = BallFeature::Kind::kEdge;
      found.along_W =
          (mesh().position(triangle, (k + 1) % 3) - mesh().position(triangle, k)).normalized();
      break;
    case SurfacePlace::On::kCorner:
      found.kind = BallFeature::Kind::kCorner;
      break;
  }
  return found;
}

// Lists the triangles around a centre, for steps up to about `reach`.
void MeshBall::look_around(const Vector3d& q, double reach) noexcept {
  const double radius = radius_ + std::max(kReachSteps * reach, kReachRadii * radius_);
  near_centre_ = q;
  near_radius_ = tree_->near(q, radius, near_, near_count_);
  if (near_count_ > 0) return;
  clear_centre_ = q;
  // With a margin for the rounding of squares.
  const double clear = (1 - 0x1p-20) * (tree_->distance(q, kInfinite) - radius_);
  clear_squared_ = clear * clear;
}

std::span<const BallFeature> MeshBall::features(const Vector3d& q, double& reach) noexcept {
  double away = (q - near_centre_).norm();
  // Written so that NaN looks around.
  if (!(near_radius_ - away - radius_ >= reach)) {
    look_around(q, reach);
    away = 0;
  }
  reach = std::min(near_radius_ - away - radius_, kReachRound * reach);
  std::size_t count = 0;
  bool dropped = false;
  const auto drop_hidden = [&] {
    const std::size_t kept = without_hidden(count);
    dropped = dropped || kept < count;
    count = kept;
  };
  // Adds the triangles that no feature hides yet.
  const auto add = [&](bool drop) {
    for (std::size_t i = 0; i < near_count_; ++i) {
      const double least = near_[i].distance - away - radius_;
      if (least > reach) break;
      const std::int32_t triangle = near_[i].triangle;
      const auto hides = [&](const BallFeature& found) { return hidden(triangle, found); };
      if (std::any_of(features_.begin(), features_.begin() + static_cast<std::ptrdiff_t>(count),
                      hides)) {
        continue;
      }
      if (drop && count == features_.size()) drop_hidden();
      if (count == features_.size()) {
        // No room for the others: the step ends before it can meet them.
        reach = std::max(0.0, least);
        break;
      }
      features_[count] = feature(triangle, q);
      if (features_[count].gap <= reach) ++count;
    }
  };
  add(true);
  drop_hidden();
  // A triangle behind the plane of a dropped feature may be in front of all others.
  if (dropped) add(false);
  return {features_.data(), count};
}

// Returns whether a triangle is wholly behind the plane of a feature.
bool MeshBall::hidden(std::int32_t triangle, const BallFeature& feature) const noexcept {
  for (std::size_t k = 0; k < 3; ++k) {
    if (feature.n_W.dot(mesh().position(triangle, k) - feature.p_W) > rounding_) return false;
  }
  return true;
}

// Sorts the features, the nearest first, and drops those hidden by a nearer one. Returns their
// number.
std::size_t MeshBall::without_hidden(std::size_t count) noexcept {
  const auto begin = features_.begin();
  std::sort(begin, begin + static_cast<std::ptrdiff_t>(count),
            [](const BallFeature& a, const BallFeature& b) {
              return a.gap < b.gap || (a.gap == b.gap && a.id < b.id);
            });
  std::size_t kept = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const auto hides = [&](const BallFeature& found) { return hidden(features_[i].id, found); };
    if (std::any_of(begin, begin + static_cast<std::ptrdiff_t>(kept), hides)) continue;
    if (kept != i) features_[kept] = features_[i];
    ++kept;
  }
  return kept;
}

SolidEntry MeshBall::first_entry(const Vector3d& from, const Vector3d& to) noexcept {
  if (clear(from, to)) return {};
  const double step = (to - from).norm();
  // Written so that NaN meets nothing.
  if (!(step > 0 && step < kInfinite)) return {};
  const double clear = tree_->distance(from, kInfinite) - radius_;
  if (clear > step) {
    clear_centre_ = from;
    clear_squared_ = (1 - 0x1p-19) * clear * clear;
    return {};
  }
  SolidEntry entry{.triangle = -1, .parameter = 1};
  tree_->along(from, to, radius_ + rounding_, [&](std::int32_t triangle) {
    const double share = meets_convex(from, to, rounding_, entry.parameter,
                                      [&](const Vector3d& x) { return feature(triangle, x); });
    if (!(share <= entry.parameter)) return;
    // Of several at the same place, the first.
    if (share == entry.parameter && entry.triangle >= 0 && triangle > entry.triangle) return;
    entry = {.triangle = triangle, .parameter = share};
  });
  if (entry.triangle >= 0 && begins_inside(from)) return {};
  return entry;
}

// Returns whether a path begins inside, by more than rounding.
bool MeshBall::begins_inside(const Vector3d& q) const noexcept {
  return tree_->distance(q, radius_) < radius_ - 4 * rounding_ || search_->inside(q);
}

bool MeshBall::inside(const Vector3d& q) const noexcept {
  return tree_->distance(q, radius_) < radius_ || search_->inside(q);
}

}  // namespace thimble::render
