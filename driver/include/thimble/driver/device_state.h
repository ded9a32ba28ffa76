#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "thimble/driver/orientation.h"

namespace thimble::driver {

/// Holds what the driver knows of an arm at one tick: the input of every force law.
///
/// Frames: W world, T tip of the arm (where the hand holds it).
struct DeviceState {
  std::int64_t time_ns = 0;       ///< Time of this tick on the loop's clock.
  std::uint64_t tick = 0;         ///< Number of this tick, 0 for the first.
  double dt = 0;                  ///< Time since the previous tick, s; 0 on the first.
  Eigen::Vector3d p_WT{0, 0, 0};  ///< Position of the tip in the world, m.
  Eigen::Vector3d v_WT{0, 0, 0};  ///< Estimated velocity of the tip in the world, m/s.
  Eigen::Vector3d q{0, 0, 0};     ///< Joint angles, rad (see the arm's geometry for zero and sign).
  std::array<std::int32_t, 3> counts{};  ///< Encoder counts as they came over the wire.
  std::uint16_t buttons = 0;     ///< Buttons, one bit each; bit 0 is the arm's first button.
  bool fresh = false;            ///< True if a new report arrived for this tick.
  bool has_orientation = false;  ///< The arm tells how the stylus is turned.
  bool has_gripper = false;      ///< The arm has a gripper.
  float gripper = 0;             ///< Opening of the gripper, m; 0: closed, or none.
  /// Rotation of the stylus in the world; the identity where the arm has no orientation.
  Eigen::Matrix3d R_WT = Eigen::Matrix3d::Identity();
  TipQuaternion q_WT{};           ///< The same as a quaternion, of which R_WT is made; else zeros.
  std::array<float, 3> gimbal{};  ///< Angles of the gimbal's axes, rad; zeros where it has none.
};

}  // namespace thimble::driver
