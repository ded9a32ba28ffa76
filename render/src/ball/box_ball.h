#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>

#include "ball/ball_feature.h"
#include "ball/ball_source.h"
#include "ball/convex_ball.h"
#include "thimble/render/field/box.h"
#include "world_solid.h"

namespace thimble::render {

/// BallSource over a box without a mesh. W, m.
class BoxBall : public ConvexBall<BoxBall> {
 public:
  /// Takes the box and the radius of the ball, m, > 0.
  BoxBall(const Box& box, double radius) noexcept : ConvexBall<BoxBall>(radius), box_(box) {}

  /// Precondition: the centre is outside of the box. `id` has no meaning here.
  BallFeature feature(std::int32_t, const Eigen::Vector3d& q) const noexcept {
    const Eigen::Vector3d q_O = box_.to_box(q);
    const Eigen::Vector3d c_O = q_O.cwiseMin(box_.half_sides).cwiseMax(-box_.half_sides);
    const Eigen::Vector3d from_O = q_O - c_O;
    const double distance = from_O.norm();
    BallFeature found{.p_W = box_.p_WO + box_.R_WO * c_O,
                      .n_W = box_.R_WO * (from_O / distance),
                      .gap = distance - radius_};
    Eigen::Index farthest = 0;
    from_O.cwiseAbs().maxCoeff(&farthest);
    found.id = 2 * static_cast<std::int32_t>(farthest) + (from_O[farthest] > 0 ? 1 : 0);
    int beside = 0;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      if (from_O[axis] != 0) {
        ++beside;
      } else {
        found.along_W = box_.R_WO.col(axis);
      }
    }
    found.kind = beside > 2    ? BallFeature::Kind::kCorner
                 : beside == 2 ? BallFeature::Kind::kEdge
                               : BallFeature::Kind::kFace;
    return found;
  }
  bool in_solid(const Eigen::Vector3d& q) const noexcept {
    return (box_.to_box(q).cwiseAbs() - box_.half_sides).maxCoeff() < 0;
  }
  bool inside(const Eigen::Vector3d& q) const noexcept {
    const Eigen::Vector3d beside = (box_.to_box(q).cwiseAbs() - box_.half_sides).cwiseMax(0.0);
    return beside.norm() < radius_;
  }
  SolidBox box() const noexcept {
    const Eigen::Vector3d half = box_.R_WO.cwiseAbs() * box_.half_sides;
    return {(box_.p_WO - half).array() - radius_, (box_.p_WO + half).array() + radius_};
  }
  double rounding() const noexcept {
    return 64 * 0x1p-53 * (2 * box_.half_sides.norm() + box_.p_WO.norm() + radius_);
  }

 private:
  Box box_;
};

static_assert(BallSource<BoxBall>);

}  // namespace thimble::render
