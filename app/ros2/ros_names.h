#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace thimble::ros2 {

/// Convention for the names, axes and units of a run's topics.
enum class RosStyle : std::uint8_t {
  kPlain,  ///< Short names; axes of the world frame W.
  kCrtk,   ///< Names of the Collaborative Robotics Toolkit; axes of W.
  kOmni,   ///< Names, axes and joints of the drivers of the Omni (omni_msgs).
};

/// The names of topics, without namespace; null: not in this style.
struct RosNames {
  const char* joints;
  const char* pose;
  const char* twist;
  const char* wrench;
  const char* buttons;
  const char* state;     ///< OmniState
  const char* robot;     ///< The arm as a URDF; its joints are those of `joints`.
  const char* force_in;  ///< Input of forces.
  const char* hand_in;   ///< Input of the simulated hand's target.
};

/// Returns the names of a style. Real-time: safe.
const RosNames& ros_names(RosStyle style) noexcept;

/// Returns a name that is valid for ROS 2 frames and a URDF: only letters, digits and _.
std::string frame_name_of(const std::string& text);

/// Returns a frame for each object of a scene, by its name. Names that are equal as frames get a
/// number, so that each object has its own frame.
std::vector<std::string> object_frames(const std::vector<std::string>& names);

/// Converts a vector of the world (frame W: x to the user, y to the right, z up) to the axes of a
/// style. Those of the Omni's drivers are x to the right, y away from the user, z up [S
/// bharatm11/Geomagic_Touch_ROS_Drivers omni_state.cpp]. Real-time: safe.
std::array<double, 3> to_style(RosStyle style, const std::array<double, 3>& v_W) noexcept;
/// Converts a vector back. Real-time: safe.
std::array<double, 3> from_style(RosStyle style, const std::array<double, 3>& v) noexcept;
/// Converts a rotation relative to W (w, x, y, z) to one relative to the axes of a style.
/// Real-time: safe.
std::array<double, 4> to_style(RosStyle style, const std::array<double, 4>& q_W) noexcept;

/// Returns the joint names of a style; `count`: 3, or 6 with the gimbal's.
std::vector<std::string> joint_names(RosStyle style, std::size_t count);
/// Returns the joint angles (rad) in a style: those of the arm, then those of the gimbal. The
/// Omni's drivers change signs and offsets [S as above, publish_omni_state]. Real-time: safe.
std::array<double, 6> joint_angles(RosStyle style, const std::array<double, 3>& q,
                                   const std::array<float, 3>& gimbal) noexcept;

}  // namespace thimble::ros2
