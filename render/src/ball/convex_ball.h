#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <span>

#include "ball/ball_feature.h"
#include "ball/ball_source.h"
#include "world_solid.h"

namespace thimble::render {

/// What BallSources over one convex shape have in common. `Self` is the derived class (CRTP); it
/// provides `feature`, `in_solid` (whether a point is inside of the shape itself), `inside`, `box`
/// and `rounding`. W, m.
template <class Self>
class ConvexBall {
 public:
  std::span<const BallFeature> features(const Eigen::Vector3d& q, double& reach) noexcept {
    reach = std::numeric_limits<double>::infinity();
    feature_ = self().feature(0, q);
    return {&feature_, 1};
  }
  bool clear(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const noexcept {
    return (from - clear_centre_).squaredNorm() < clear_squared_ &&
           (to - clear_centre_).squaredNorm() < clear_squared_;
  }
  SolidEntry first_entry(const Eigen::Vector3d& from, const Eigen::Vector3d& to) noexcept {
    if (clear(from, to) || self().in_solid(from)) return {};
    const auto feature = [this](const Eigen::Vector3d& x) { return self().feature(0, x); };
    const double rounding = self().rounding();
    const BallFeature begin = feature(from);
    // Written so that NaN meets nothing.
    if (!(begin.gap >= -4 * rounding)) return {};
    clear_centre_ = from;
    clear_squared_ = begin.gap > 0 ? (1 - 0x1p-20) * begin.gap * begin.gap : -1;
    const double share = meets_convex(from, to, rounding, 1, feature);
    if (!(share <= 1)) return {};
    return {.triangle = feature(from + share * (to - from)).id, .parameter = share};
  }
  double radius() const noexcept { return radius_; }

 protected:
  /// Takes the radius of the ball, m, > 0.
  explicit ConvexBall(double radius) noexcept : radius_(radius) {}

  double radius_ = 0;

 private:
  const Self& self() const noexcept { return static_cast<const Self&>(*this); }

  BallFeature feature_;
  // A ball of centres without contact.
  Eigen::Vector3d clear_centre_{0, 0, 0};
  double clear_squared_ = -1;
};

}  // namespace thimble::render
