#include "body/dent/bendable_polygon.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "mesh/position_range.h"
#include "mesh/surface_weights.h"

namespace thimble::render {
namespace {

// Minimum distance of splitting points from the ends of what they split, as a share of it, so that
// no drawn triangle is without area. A thousandth of a triangle is not visible.
constexpr double kApart = 1e-3;

// Faster than any hand, m/s [PHYSICS 7: strokes of 2 m/s]: dampers do not transmit a larger jump in
// a tick as a blow.
constexpr double kSpeedMax = 10;

}  // namespace

BendablePolygon::BendablePolygon(std::shared_ptr<const ContactMesh> mesh, DentMotion motion)
    : mesh_(std::move(mesh)), motion_(std::move(motion)), drawing_(mesh_) {}

driver::Result<BendablePolygon> BendablePolygon::build(std::shared_ptr<const ContactMesh> mesh,
                                                       const DentSettings& settings) {
  for (std::int32_t t = 0; t < mesh->triangle_count(); ++t) {
    const auto& n = mesh->cell(t).neighbours;
    if (n[0] == n[1] || n[1] == n[2] || n[2] == n[0]) {
      return driver::Error{"Triangle " + std::to_string(t) +
                           " shares two edges with the same neighbour and cannot bend. Repair the "
                           "mesh first: thimble mesh FILE --repair OUT.off"};
    }
  }
  auto motion = DentMotion::build(std::make_shared<const VertexLinks>(*mesh), settings);
  if (!motion) return motion.error();
  return BendablePolygon(std::move(mesh), std::move(motion).value());
}

// Splits another triangle; an edge shared with the last one keeps its point.
void BendablePolygon::go_to(std::int32_t triangle) noexcept {
  const auto& corners = mesh_->corners(triangle);
  const std::array<EdgePoint, 3> before = edges_;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::int32_t from = corners[k];
    const std::int32_t to = corners[(k + 1) % 3];
    const auto kept = std::find_if(before.begin(), before.end(),
                                   [&](const EdgePoint& e) { return e.splits(from, to); });
    if (triangle_ >= 0 && kept != before.end()) {
      edges_[k] = *kept;
      edges_[k].turn(from, to);
    } else {
      edges_[k].begin(from, to);
    }
  }
  triangle_ = triangle;
  motion_.gather(corners);
}

void BendablePolygon::touch(std::int32_t triangle, const Eigen::Vector3d& weights,
                            const Eigen::Vector3d& p_WT) noexcept {
  // Written so that NaN means no touch.
  if (!(weights.minCoeff() >= 0 && std::abs(weights.sum() - 1) < 1e-6 && within_range(p_WT))) {
    rest();
    return;
  }
  const bool was_touching = triangle_ >= 0;
  if (triangle != triangle_) go_to(triangle);
  weights_ = weights;
  const Eigen::Vector3d closest = point_at(*mesh_, triangle, weights);
  const Eigen::Vector3d last = cursor_;
  const Eigen::Vector3d way = closest - p_WT;
  const double distance = way.norm();
  const double depth = mesh_->depth(triangle, p_WT);
  const bool below = depth > 0 && distance > 0;
  up_ = below ? Eigen::Vector3d(way / distance) : Eigen::Vector3d(0, 0, 0);
  per_way_ = below ? depth / distance : 0;
  cursor_ = below ? Eigen::Vector3d(-depth * up_) : Eigen::Vector3d(0, 0, 0);
  const DentSettings& settings = motion_.settings();
  const auto& corners = mesh_->corners(triangle);
  DentMotion::CursorSpring spring;
  spring.target = cursor_;
  if (was_touching) {
    spring.rate = (cursor_ - last) / settings.step;
    const double speed = spring.rate.norm();
    if (speed > kSpeedMax) spring.rate *= kSpeedMax / speed;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const double w = weights[static_cast<Eigen::Index>(k)];
    spring.stiffness = settings.reach * motion_.stiffness() * (w / std::max(1 - w, 1e-12));
    spring.damping = settings.reach * settings.damping * w;
    motion_.pull(k, corners[k], spring);
  }
  motion_.step();
  f_T_W_ = -motion_.force(0) - motion_.force(1) - motion_.force(2);
  for (std::size_t k = 0; k < 3; ++k) {
    const auto a = static_cast<Eigen::Index>(k);
    const Eigen::Index b = (a + 1) % 3;
    const double both = 2 * weights[a] * weights[b];
    const double sum = both + weights[3 - a - b];
    const Eigen::Vector3d& from = mesh_->position(triangle, k);
    const Eigen::Vector3d side = mesh_->position(triangle, (k + 1) % 3) - from;
    edges_[k].step(
        {.share = sum > 0 ? both / sum : 0,
         .place = std::clamp((closest - from).dot(side) / side.squaredNorm(), kApart, 1 - kApart),
         .cursor = cursor_,
         .from = motion_.u(corners[k]),
         .to = motion_.u(corners[(k + 1) % 3])},
        settings, motion_.stiffness());
  }
}

Eigen::Vector3d BendablePolygon::pull_at_tip(const Eigen::Matrix3d& change) const noexcept {
  // Nearer to a corner, the stretch of its spring has lost digits, but its force has not.
  constexpr double kNearCorner = 1e-3;
  if (triangle_ < 0) return Eigen::Vector3d::Zero();
  const auto& corners = mesh_->corners(triangle_);
  const Eigen::Vector3d& a = mesh_->position(corners[0]);
  const double stiffness = motion_.settings().reach * motion_.stiffness();
  const double along = f_T_W_.dot(up_);
  const Eigen::Vector3d turning = per_way_ * (f_T_W_ - along * up_);
  Eigen::Vector3d aside(0, 0, 0);
  for (std::size_t k = 0; k < 3; ++k) {
    const double w = weights_[static_cast<Eigen::Index>(k)];
    const Eigen::Vector3d stretch =
        1 - w > kNearCorner ? Eigen::Vector3d((cursor_ - motion_.u(corners[k])) / (1 - w))
                            : Eigen::Vector3d(motion_.force(k) / (stiffness * w));
    aside[static_cast<Eigen::Index>(k)] =
        (mesh_->position(corners[k]) - a).dot(turning) + stiffness / 2 * stretch.squaredNorm();
  }
  return along * mesh_->cell(triangle_).face.n + turning - change.transpose() * aside;
}

void BendablePolygon::rest() noexcept {
  triangle_ = -1;
  cursor_.setZero();
  f_T_W_.setZero();
  motion_.release();
  motion_.step();
}

void BendablePolygon::draw(BodyPatch& patch) noexcept {
  drawing_.begin();
  if (triangle_ >= 0) {
    const Eigen::Vector3d apart = (weights_.array() + kApart) / (1 + 3 * kApart);
    drawing_.split(triangle_, apart, cursor_,
                   {PatchDrawing::Split{edges_[0].place(), edges_[0].u()},
                    PatchDrawing::Split{edges_[1].place(), edges_[1].u()},
                    PatchDrawing::Split{edges_[2].place(), edges_[2].u()}},
                   motion_);
  }
  drawing_.add_moving(motion_);
  drawing_.finish(patch);
}

}  // namespace thimble::render
