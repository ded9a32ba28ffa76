#include "body/shape/clay_shape.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace thimble::render {

using Eigen::Vector3d;

ClayShape::ClayShape(const ClayChoice& choice, double stiffness, std::size_t vertices)
    : choice_(choice), stiffness_(stiffness), sets_(vertices, Vector3d::Zero()) {}

double ClayShape::print(double distance_squared) const noexcept {
  const double left = 1 - distance_squared / (choice_.radius * choice_.radius);
  return left > 0 ? left * left : 0;
}

double ClayShape::press(const ShapeContact& contact, std::span<const std::int32_t> corners,
                        std::span<const std::int32_t> patch, std::span<const Vector3d> first_places,
                        double step) noexcept {
  const double beyond = contact.depth - choice_.yield_force / stiffness_;
  // Written so that NaN moves nothing.
  if (!(beyond > 0) || !(step > 0) || !std::isfinite(contact.depth)) return 0;
  const double flow = std::min(beyond, choice_.flow_rate * step);
  // The corners of the touched triangle go along even where the print is smaller than the triangle.
  const auto share_of = [&](std::int32_t vertex) {
    const auto v = static_cast<std::size_t>(vertex);
    double share = print((first_places[v] - contact.p_first).squaredNorm());
    for (std::size_t k = 0; k < 3; ++k) {
      if (corners[k] == vertex) {
        share = std::max(share, contact.weights[static_cast<Eigen::Index>(k)]);
      }
    }
    return share;
  };
  double at_place = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    at_place += contact.weights[static_cast<Eigen::Index>(k)] * share_of(corners[k]);
  }
  // Inwards as it was at first, so that walls of a pit neither fold nor crumple: as much farther as
  // that is aslant, up to walls of 70 degrees. The place's share is at least a third: the squares
  // of three weights whose sum is 1.
  constexpr double kAslant = 0.34;
  const double aslant = std::max(contact.first_inward.dot(contact.inward), kAslant);
  const Vector3d way = flow / (at_place * aslant) * contact.first_inward;
  if (!way.allFinite()) return 0;
  for (const std::int32_t vertex : patch) {
    Vector3d& set = sets_[static_cast<std::size_t>(vertex)];
    set += share_of(vertex) * way;
    // The nearest place in the ball: the way there never goes against the force.
    const double away = set.norm();
    if (away > choice_.movement_limit) set *= choice_.movement_limit / away;
  }
  return flow;
}

void ClayShape::moved(double way, double depth) noexcept {
  // The force that the slider holds against while it moves is the one that is left.
  const double heat = stiffness_ * (depth - way) * way;
  if (way > 0 && heat > 0) dissipated_ += heat;
}

}  // namespace thimble::render
