#pragma once

#include <Eigen/Core>
#include <array>

#include "bringup/identify/weak_form/fitted_motion.h"

namespace thimble::bringup {

/// Coulomb friction along each axis of the base, and in its two directions.
///
/// Friction of c+ one way and c- the other way is, moving or at rest, to the last bit that of
/// (c+ + c-)/2 both ways and a constant force of (c- - c+)/2. So a difference along the vertical is
/// part of the weight; a horizontal constant force is a difference, or a base that stands aslant.
struct FrictionDirections {
  std::array<Estimate, 3> mean;  ///< Of both directions, N for each axis of the base.
  /// Half of what friction is more in the negative direction than in the positive one, N; without
  /// what is along the vertical.
  std::array<Estimate, 3> uneven;
  Eigen::Vector3d down_B{0, 0, -1};  ///< The vertical, along which no difference is told.
  bool axes_differ = false;          ///< The axes' friction differs: the data show it.
  bool directions_differ = false;    ///< That of the directions does.

  /// Returns whether a difference between the directions of an axis can be told from the weight.
  bool tells(int axis) const { return std::abs(down_B[axis]) < 0.5; }
};

/// Looks for friction that differs from axis to axis and from direction to direction, and believes
/// it where the Bayesian information does. `mass`: at the tip, kg. Real-time: never from the servo
/// thread.
FrictionDirections friction_directions(const FittedMotion& motion, const Estimate& mass);

}  // namespace thimble::bringup
