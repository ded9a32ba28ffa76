#pragma once

#include <Eigen/Core>
#include <optional>

#include "plant/board_geometry.h"
#include "plant/serial_pose.h"
#include "thimble/driver/arm_model.h"
#include "thimble/driver/linkage_arm.h"
#include "thimble/driver/serial_arm.h"

namespace thimble::device_sim {

/// Kinematics of an arm at a tip position, as a plant needs them. Frames: B base, T tip.
struct TipPose {
  Eigen::Vector3d q{0, 0, 0};  ///< Joint angles, rad.
  /// d q / d p_BT, rad/m: joints turn by `G v_BT`, and torques exert the force `G^T tau` on the
  /// tip.
  Eigen::Matrix3d G = Eigen::Matrix3d::Zero();
};

/// Returns the pose of a serial arm whose tip is at p_BT (m), bounded near singular poses like
/// SerialPose; empty beyond its reach. Real-time: safe.
inline std::optional<TipPose> tip_pose(const driver::SerialArm& arm,
                                       const Eigen::Vector3d& p_BT) noexcept {
  const SerialPose pose(arm, p_BT);
  if (!pose.within_reach()) return {};
  TipPose found{.q = pose.angles()};
  for (int i = 0; i < 3; ++i) {
    found.G.row(i) = pose.force_from(Eigen::Vector3d::Unit(i)).transpose();
  }
  return found;
}

/// Returns the same from inverse kinematics only. G is a central difference over 1 um (relative
/// error about 1e-9). Axes along which the tip cannot move have unit vectors. Real-time: safe.
template <class Geometry>
std::optional<TipPose> tip_pose_by_inverse(const Geometry& arm,
                                           const Eigen::Vector3d& p_BT) noexcept {
  constexpr double kDifference = 1e-6;  // m
  const auto here = arm.inverse(p_BT);
  if (!here) return {};
  TipPose found{.q = *here};
  const int axes = driver::motor_count(arm);
  for (int axis = 0; axis < axes; ++axis) {
    const Eigen::Vector3d step = kDifference * Eigen::Vector3d::Unit(axis);
    const auto ahead = arm.inverse(p_BT + step), behind = arm.inverse(p_BT - step);
    if (!ahead || !behind) return {};
    found.G.col(axis) = (*ahead - *behind) / (2 * kDifference);
  }
  for (int axis = axes; axis < 3; ++axis) found.G(axis, axis) = 1;
  return found;
}

/// Returns the same for an arm with a linkage. Real-time: safe.
inline std::optional<TipPose> tip_pose(const driver::LinkageArm& arm,
                                       const Eigen::Vector3d& p_BT) noexcept {
  return tip_pose_by_inverse(arm, p_BT);
}
/// Returns the same for any other geometry. Real-time: safe.
inline std::optional<TipPose> tip_pose(const BoardGeometry& arm,
                                       const Eigen::Vector3d& p_BT) noexcept {
  return tip_pose_by_inverse(arm, p_BT);
}

}  // namespace thimble::device_sim
