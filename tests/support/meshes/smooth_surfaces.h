#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace thimble::support {

using Eigen::Vector3d;

// Smooth closed surfaces defined by a function that is negative inside and 0 on the surface, with
// its gradient. They are references for meshes of them. Centred at the origin, m.

struct SphereSurface {
  double radius;

  double value(const Vector3d& p) const { return p.norm() - radius; }
  Vector3d gradient(const Vector3d& p) const { return p.normalized(); }
};

struct TorusSurface {
  double ring_radius;
  double tube_radius;

  double value(const Vector3d& p) const { return from_ring(p).norm() - tube_radius; }
  Vector3d gradient(const Vector3d& p) const { return from_ring(p).normalized(); }

 private:
  Vector3d from_ring(const Vector3d& p) const {
    return p - ring_radius * Vector3d(p.x(), p.y(), 0).normalized();
  }
};

/// The space on one side of the gyroid sin x cos y + sin y cos z + sin z cos x = 0, rounded off at
/// a sphere, so that it is closed and smooth. It is a saddle everywhere except near the sphere.
struct GyroidSurface {
  double wave;      ///< rad/m: the gyroid repeats after 2 pi / wave.
  double radius;    ///< Of the sphere, m.
  double rounding;  ///< Of the seam of gyroid and sphere, in their own values (about 1).

  double value(const Vector3d& p) const {
    const double a = gyroid(p);
    const double b = ball(p);
    // The larger of the two, smoothed where they are equal.
    return (a + b + std::hypot(a - b, rounding)) / 2;
  }

  Vector3d gradient(const Vector3d& p) const {
    const double difference = gyroid(p) - ball(p);
    const double share = (1 + difference / std::hypot(difference, rounding)) / 2;
    return share * gyroid_gradient(p) + (1 - share) * 2 / (radius * radius) * p;
  }

 private:
  double gyroid(const Vector3d& p) const {
    const Vector3d s = (wave * p).array().sin();
    const Vector3d c = (wave * p).array().cos();
    return s.x() * c.y() + s.y() * c.z() + s.z() * c.x();
  }
  Vector3d gyroid_gradient(const Vector3d& p) const {
    const Vector3d s = (wave * p).array().sin();
    const Vector3d c = (wave * p).array().cos();
    return wave * Vector3d(c.x() * c.y() - s.z() * s.x(), c.y() * c.z() - s.x() * s.y(),
                           c.z() * c.x() - s.y() * s.z());
  }
  double ball(const Vector3d& p) const { return p.squaredNorm() / (radius * radius) - 1; }
};

/// Moves a point near a surface onto it, along the gradient (Newton).
template <class Surface>
Vector3d onto(const Surface& surface, Vector3d p) {
  for (int i = 0; i < 50; ++i) {
    const Vector3d gradient = surface.gradient(p);
    const Vector3d step = surface.value(p) / gradient.squaredNorm() * gradient;
    p -= step;
    if (step.norm() < 1e-15) break;
  }
  return p;
}

/// Returns the outward unit normal of a surface at a point of it.
template <class Surface>
Vector3d unit_normal(const Surface& surface, const Vector3d& p) {
  return surface.gradient(p).normalized();
}

}  // namespace thimble::support
