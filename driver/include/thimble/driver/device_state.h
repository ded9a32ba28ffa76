#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "thimble/driver/orientation.h"

namespace thimble::driver {

/// State of an arm at one tick: the input of every force law.
///
/// Frames: W world, T tip of the arm (where the hand holds it).
struct DeviceState {
  std::int64_t time_ns = 0;       ///< Time of this tick on the loop's clock, ns.
  std::uint64_t tick = 0;         ///< Number of this tick, 0 for the first.
  double dt = 0;                  ///< Time since the previous tick, s; 0 on the first.
  Eigen::Vector3d p_WT{0, 0, 0};  ///< Position of the tip in the world, m.
  Eigen::Vector3d v_WT{0, 0, 0};  ///< Estimated velocity of the tip in the world, m/s.
  Eigen::Vector3d q{0, 0, 0};     ///< Joint angles, rad (see the arm's geometry for zero and sign).
  std::array<std::int32_t, 3> counts{};  ///< Raw encoder counts.
  std::uint16_t buttons = 0;     ///< Buttons, one bit each; bit 0 is the arm's first button.
  bool fresh = false;            ///< True if a new report arrived for this tick.
  bool has_orientation = false;  ///< True if the arm reports the orientation of the stylus.
  bool has_gripper = false;      ///< True if the arm has a gripper.
  float gripper = 0;             ///< Gripper opening, m; 0 if closed or missing.
  /// Rotation of the stylus in the world; the identity if the arm reports no orientation.
  Eigen::Matrix3d R_WT = Eigen::Matrix3d::Identity();
  /// Quaternion from which R_WT is computed; zeros if the arm reports no orientation.
  TipQuaternion q_WT{};
  std::array<float, 3> gimbal{};  ///< Angles of the gimbal axes, rad; zeros without a gimbal.
};

}  // namespace thimble::driver
