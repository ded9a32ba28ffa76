#include "body/shape/plastic_base.h"

#include <algorithm>
#include <cmath>

namespace thimble::render {

void PlasticBase::pull(const Eigen::Vector3d& x, double step) noexcept {
  const Eigen::Vector3d stretch = x - p_;
  const double length = stretch.norm();
  const double beyond = length - settings_.yield_force / settings_.stiffness;
  // Written so that NaN moves nothing.
  if (!settings_.valid() || !(step > 0) || !(beyond > 0) || !std::isfinite(length)) return;
  const double flow = std::min(beyond, settings_.flow_rate * step);
  Eigen::Vector3d to = p_ + flow / length * stretch;
  const double away = to.norm();
  // The nearest point of the ball: the way there never goes against the force.
  if (away > settings_.movement_limit) to *= settings_.movement_limit / away;
  // The force that the slider holds against while it moves is the one that is left.
  dissipated_ += std::max(settings_.stiffness * (x - to).dot(to - p_), 0.0);
  p_ = to;
}

}  // namespace thimble::render
