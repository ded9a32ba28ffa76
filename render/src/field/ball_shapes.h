#pragma once

#include <Eigen/Core>
#include <cmath>

#include "thimble/render/field/half_space.h"
#include "thimble/render/field/primitive_place.h"
#include "thimble/render/field/round_shapes.h"
#include "thimble/render/field/sphere.h"

namespace thimble::render {

/// Half-space under a ball: a half-space for the centre of the ball. A PrimitiveShape.
struct BallHalfSpace : HalfSpace {
  double tip_radius = 0;  ///< Radius of the ball, m.

  BallHalfSpace(const HalfSpace& plane, double radius)
      : HalfSpace{.n_W = plane.n_W, .p_WO = plane.p_WO + radius * plane.n_W}, tip_radius(radius) {}
};

/// Sphere under a ball: a larger sphere for the centre of the ball. A PrimitiveShape.
struct BallSphere : Sphere {
  double tip_radius = 0;  ///< Radius of the ball, m.

  BallSphere(const Sphere& sphere, double ball_radius)
      : Sphere{.p_WO = sphere.p_WO, .radius = sphere.radius + ball_radius},
        tip_radius(ball_radius) {}

  /// Returns the ratio of a path on the sphere to that of a tip `depth` (m) below the larger one.
  /// Real-time: safe.
  double stretch(double depth) const noexcept { return (radius - tip_radius) / (radius - depth); }
};

/// Capsule under a ball: a thicker capsule for the centre of the ball. A PrimitiveShape.
struct BallCapsule : Capsule {
  double tip_radius = 0;  ///< Radius of the ball, m.

  BallCapsule(const Capsule& capsule, double ball_radius)
      : Capsule(capsule), tip_radius(ball_radius) {
    radius += ball_radius;
  }

  /// Returns the derivative of the point below the ball with respect to the tip (W, m). Real-time:
  /// safe.
  Eigen::Matrix3d derivative(const Eigen::Vector3d& p_W,
                             const PrimitivePlace& place) const noexcept {
    Capsule capsule = *this;
    capsule.radius -= tip_radius;
    return capsule.derivative(p_W, {.depth = place.depth - tip_radius, .n_W = place.n_W});
  }
};

/// Torus under a ball: a thicker tube for the centre of the ball. A PrimitiveShape. In a hole
/// narrower than the ball, the tube passes the axis; the ball then rests on the axis, against all
/// sides.
struct BallTorus : Torus {
  double tip_radius = 0;  ///< Radius of the ball, m.

  BallTorus(const Torus& torus, double ball_radius) : Torus(torus), tip_radius(ball_radius) {
    tube += ball_radius;
  }

  /// As Torus::place.
  PrimitivePlace place(const Eigen::Vector3d& p_W,
                       const Eigen::Vector3d& n_before_W) const noexcept {
    const PrimitivePlace place = Torus::place(p_W, n_before_W);
    if (!(tube > radius && place.depth > 0)) return place;
    const Meridian m = meridian(p_W, n_before_W);
    const Eigen::Vector3d down_W = rest_W(p_W, n_before_W) - p_W;
    if (m.rho + place.depth * m.out_W.dot(place.n_W) > 0 || !(down_W.norm() > 0)) return place;
    return {.depth = down_W.norm(), .n_W = down_W.normalized()};
  }
  /// As BallCapsule::derivative.
  Eigen::Matrix3d derivative(const Eigen::Vector3d& p_W,
                             const PrimitivePlace& place) const noexcept {
    Torus torus = *this;
    torus.tube -= tip_radius;
    const Meridian m = meridian(p_W, place.n_W);
    if (tube > radius && !(m.rho + place.depth * m.out_W.dot(place.n_W) > 0)) {
      return Eigen::Matrix3d::Zero();
    }
    return torus.derivative(p_W, {.depth = place.depth - tip_radius, .n_W = place.n_W});
  }

 private:
  // Returns where the ball rests in the hole: on the side of the last felt normal, if any.
  Eigen::Vector3d rest_W(const Eigen::Vector3d& p_W,
                         const Eigen::Vector3d& n_before_W) const noexcept {
    const Eigen::Vector3d axis_W = R_WO.col(2);
    const double before = n_before_W.dot(axis_W);
    const double side = before != 0 ? before : to_shape(p_W).z();
    return p_WO + std::copysign(std::sqrt(tube * tube - radius * radius), side) * axis_W;
  }
};

}  // namespace thimble::render
