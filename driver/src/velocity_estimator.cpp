#include "velocity_estimator.h"

#include <cmath>
#include <numbers>

#include "math/elementary.h"

namespace thimble::driver {

VelocityEstimator::VelocityEstimator(double corner_frequency) noexcept
    : corner_frequency_(corner_frequency > 0 ? corner_frequency : 0) {}

Eigen::Vector3d VelocityEstimator::update(const Eigen::Vector3d& p, double dt) noexcept {
  if (!primed_) {
    primed_ = true;
    p_ = p;
    v_.setZero();
    return v_;
  }
  if (!(dt > 0)) return v_;
  if (corner_frequency_ > 0 && dt != pole_dt_) {
    pole_dt_ = dt;
    gain_ = -math::expm1(-2 * std::numbers::pi * corner_frequency_ * dt);
  }
  v_ += gain_ * ((p - p_) / dt - v_);
  p_ = p;
  return v_;
}

}  // namespace thimble::driver
