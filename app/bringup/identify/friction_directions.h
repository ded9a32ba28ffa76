#pragma once

#include <Eigen/Core>
#include <array>

#include "bringup/identify/weak_form/fitted_motion.h"

namespace thimble::bringup {

/// Coulomb friction along each axis of the base, and in its two directions.
///
/// Friction of c+ in one direction and c- in the other equals exactly, moving or at rest, (c+ +
/// c-)/2 in both directions plus a constant force of (c- - c+)/2. So a difference along the
/// vertical is part of the weight. A horizontal constant force is a difference, or a tilted base.
struct FrictionDirections {
  std::array<Estimate, 3> mean;  ///< Mean of both directions, N for each axis of the base.
  /// Half of the excess of friction in the negative over that in the positive direction, N; without
  /// the part along the vertical.
  std::array<Estimate, 3> uneven;
  Eigen::Vector3d down_B{0, 0, -1};  ///< The vertical, along which no difference is reported.
  bool axes_differ = false;          ///< Friction differs significantly between axes.
  bool directions_differ = false;    ///< Friction differs significantly between directions.

  /// Returns whether a difference between the directions of an axis can be distinguished from the
  /// weight.
  bool is_observable(int axis) const { return std::abs(down_B[axis]) < 0.5; }
};

/// Searches for friction that differs between axes and directions, and accepts it by the Bayesian
/// information criterion. `mass`: at the tip, kg. Real-time: never from the servo thread.
FrictionDirections friction_directions(const FittedMotion& motion, const Estimate& mass);

}  // namespace thimble::bringup
