#pragma once

#include <Eigen/Core>
#include <optional>

#include "plant/serial_pose.h"
#include "thimble/driver/linkage_arm.h"
#include "thimble/driver/serial_arm.h"

namespace thimble::device_sim {

/// What a plant needs to know of an arm's build, found from where the tip is. Frames: B base, T
/// tip.
struct TipPose {
  Eigen::Vector3d q{0, 0, 0};  ///< Joint angles, rad.
  /// d q / d p_BT, rad/m: joints turn by `G v_BT`, and torques pull on the tip by `G^T tau`.
  Eigen::Matrix3d G = Eigen::Matrix3d::Zero();
};

/// Finds the pose of a serial arm whose tip is at p_BT (m), bounded near singular poses as
/// SerialPose is; empty beyond its reach. Real-time: safe.
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

/// Finds the same of an arm with a linkage by its inverse kinematics alone, G as a central
/// difference over 1 um (error about 1e-9 of itself). Real-time: safe.
inline std::optional<TipPose> tip_pose(const driver::LinkageArm& arm,
                                       const Eigen::Vector3d& p_BT) noexcept {
  constexpr double kDifference = 1e-6;  // m
  const auto here = arm.inverse(p_BT);
  if (!here) return {};
  TipPose found{.q = *here};
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d step = kDifference * Eigen::Vector3d::Unit(axis);
    const auto ahead = arm.inverse(p_BT + step), behind = arm.inverse(p_BT - step);
    if (!ahead || !behind) return {};
    found.G.col(axis) = (*ahead - *behind) / (2 * kDifference);
  }
  return found;
}

}  // namespace thimble::device_sim
