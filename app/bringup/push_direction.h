#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "thimble/scene/arm_file.h"

namespace thimble::bringup {

/// Returns the unit vector of the world along which a check pushes a free tip: y with three motors,
/// because no weight acts along it; the horizontal direction in the plane of an arm with two motors
/// (y if the whole plane is horizontal); the line of an arm with one motor. Real-time: safe.
inline Eigen::Vector3d push_direction(const scene::ArmFile& file) noexcept {
  constexpr double kHorizontal = 1e-6;  // [chosen: far above rounding errors]
  if (file.motors() == 3) return Eigen::Vector3d::UnitY();
  if (file.motors() == 1) return file.R_WB.col(0);
  const Eigen::Vector3d across_W = file.R_WB.col(2);
  const Eigen::Vector3d level_W = Eigen::Vector3d::UnitZ().cross(across_W);
  if (level_W.norm() < kHorizontal) return Eigen::Vector3d::UnitY();
  return level_W.normalized();
}

}  // namespace thimble::bringup
