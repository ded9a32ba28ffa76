#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "ball/ball_feature.h"
#include "ball/ball_source.h"
#include "ball/convex_ball.h"
#include "thimble/render/field/round_shapes.h"
#include "world_solid.h"

namespace thimble::render {

/// Closest point of the outline of a cylinder or a cone, in the half-plane that begins at its axis.
struct OutlinePoint {
  double rho = 0;         ///< Distance from the axis, m.
  double z = 0;           ///< Position along the axis, m.
  std::int32_t face = 0;  ///< Number of a face that contains it.
  bool corner = false;    ///< It is on a rim or the tip of a cone.
};

/// Returns the point of the outline closest to a point outside. Real-time: safe, as the next one.
inline OutlinePoint closest_on_outline(const Cylinder& cylinder, double rho, double z) noexcept {
  const double h = cylinder.half_height, r = cylinder.radius;
  const bool beyond = std::abs(z) > h, beside = rho > r;
  const bool end = beyond && std::abs(z) - h >= rho - r;
  return {.rho = std::min(rho, r),
          .z = std::clamp(z, -h, h),
          .face = !end    ? Cylinder::kSide
                  : z > 0 ? 1
                          : 0,
          .corner = beyond && beside};
}
inline OutlinePoint closest_on_outline(const Cone& cone, double rho, double z) noexcept {
  const double h = cone.half_height, r = cone.radius;
  if (z < -h && rho <= r) return {.rho = rho, .z = -h, .face = 0};
  const double up = cone.cosine() * (z + h) - cone.sine() * (rho - r);
  const double along = std::clamp(up, 0.0, cone.slant());
  const bool base = z < -h && -(z + h) > rho - r;
  return {.rho = std::max(0.0, r - along * cone.sine()),
          .z = -h + along * cone.cosine(),
          .face = base ? 0 : Cone::kSide,
          .corner = up <= 0 || up >= cone.slant()};
}

/// BallSource over a cylinder or a cone without a mesh. W, m.
template <class Shape>
class RoundBall : public ConvexBall<RoundBall<Shape>> {
 public:
  /// Takes the shape and the radius of the ball, m, > 0.
  RoundBall(const Shape& shape, double radius) noexcept
      : ConvexBall<RoundBall<Shape>>(radius), shape_(shape) {}

  /// Precondition: the centre is outside of the shape. `id` has no meaning here.
  BallFeature feature(std::int32_t, const Eigen::Vector3d& q) const noexcept {
    const RoundFrame::Meridian m = shape_.meridian(q, Eigen::Vector3d::Zero());
    const OutlinePoint c = closest_on_outline(shape_, m.rho, m.z);
    const double out = m.rho - c.rho, up = m.z - c.z;
    const double distance = std::sqrt(out * out + up * up);
    return {.id = c.face,
            .kind = BallFeature::Kind::kRound,
            .p_W = q - m.in_world(out, up),
            .n_W = m.in_world(out / distance, up / distance),
            .along_W = m.around_W(),
            // Towards the axis, circles on the shape are smaller than at the centre of the ball.
            .bend_along = out > 0 ? out / m.rho : 0,
            .bend_across = c.corner ? 1.0 : 0.0,
            .gap = distance - this->radius_};
  }
  bool in_solid(const Eigen::Vector3d& q) const noexcept { return shape_.inside(q); }
  bool inside(const Eigen::Vector3d& q) const noexcept {
    return in_solid(q) || feature(0, q).gap < 0;
  }
  SolidBox box() const noexcept {
    const Eigen::Array3d axis_W = shape_.R_WO.col(2).array();
    // A margin for rounding, also of the direction of the axis.
    const Eigen::Vector3d reach =
        (1 + 0x1p-40) * (shape_.half_height * axis_W.abs() +
                         shape_.radius * (1 - axis_W.square()).max(0x1p-40).sqrt() + this->radius_);
    return {shape_.p_WO - reach, shape_.p_WO + reach};
  }
  double rounding() const noexcept {
    return 64 * 0x1p-53 *
           (2 * (shape_.half_height + shape_.radius) + shape_.p_WO.norm() + this->radius_);
  }

 private:
  Shape shape_;
};

static_assert(BallSource<RoundBall<Cylinder>> && BallSource<RoundBall<Cone>>);

}  // namespace thimble::render
