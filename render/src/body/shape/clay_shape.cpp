#include "body/shape/clay_shape.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace thimble::render {

using Eigen::Vector3d;

ClayShape::ClayShape(const ClayChoice& choice, double stiffness, std::size_t vertices,
                     std::size_t vertices_max)
    : choice_(choice), stiffness_(stiffness) {
  sets_.reserve(vertices_max);
  sets_.resize(vertices, Vector3d::Zero());
}

double ClayShape::print(double distance_squared) const noexcept {
  const double left = 1 - distance_squared / (choice_.radius * choice_.radius);
  return left > 0 ? left * left : 0;
}

Vector3d ClayShape::add(std::int32_t vertex, const Vector3d& change) noexcept {
  Vector3d& set = sets_[static_cast<std::size_t>(vertex)];
  const Vector3d before = set;
  set += change;
  // The nearest place in the ball: the way there is never against the force.
  const double away = set.norm();
  if (away > choice_.movement_limit) set *= choice_.movement_limit / away;
  return set - before;
}

void ClayShape::moved(double way, double depth) noexcept {
  // The slider moves against the force that is left.
  const double heat = stiffness_ * (depth - way) * way;
  if (way > 0 && heat > 0) dissipated_ += heat;
}

}  // namespace thimble::render
