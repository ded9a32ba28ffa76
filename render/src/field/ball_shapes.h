#pragma once

#include <Eigen/Core>

#include "thimble/render/field/half_space.h"
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

}  // namespace thimble::render
