#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace thimble::ros2 {

/// Whose names, axes and units the topics of a run have.
enum class RosStyle : std::uint8_t {
  kPlain,  ///< Short names; axes of the world frame W.
  kCrtk,   ///< Names of the Collaborative Robotics Toolkit; axes of W.
  kOmni,   ///< Names, axes and joints of the family of drivers of the Omni (omni_msgs).
};

/// The names of topics, without namespace; null: a style has none of it.
struct RosNames {
  const char* joints;
  const char* pose;
  const char* twist;
  const char* wrench;
  const char* buttons;
  const char* state;     ///< OmniState
  const char* robot;     ///< The arm as a URDF; its joints are those of `joints`.
  const char* force_in;  ///< Forces that come.
  const char* hand_in;   ///< Where the simulated hand shall go.
};

/// Returns the names of a style. Real-time: safe.
const RosNames& ros_names(RosStyle style) noexcept;

/// Returns a name that frames of ROS 2 and a URDF take: letters, digits and _ alone.
std::string frame_word(const std::string& text);

/// Returns a vector of the world (frame W: x to the user, y to the right, z up) in the axes of a
/// style. Those of the Omni's drivers are x to the right, y away from the user, z up
/// [S bharatm11/Geomagic_Touch_ROS_Drivers omni_state.cpp]. Real-time: safe.
std::array<double, 3> to_style(RosStyle style, const std::array<double, 3>& v_W) noexcept;
/// Turns a vector back. Real-time: safe.
std::array<double, 3> from_style(RosStyle style, const std::array<double, 3>& v) noexcept;
/// Returns a rotation to the world's frame (w, x, y, z) as one to the axes of a style. Real-time:
/// safe.
std::array<double, 4> to_style(RosStyle style, const std::array<double, 4>& q_W) noexcept;

/// Returns the names of joints in a style, of `count` (3, or 6 with the gimbal's).
std::vector<std::string> joint_names(RosStyle style, std::size_t count);
/// Returns the angles of the joints (rad) in a style: those of the arm, then those of the gimbal.
/// The Omni's drivers turn and shift theirs [S as above, publish_omni_state]. Real-time: safe.
std::array<double, 6> joint_angles(RosStyle style, const std::array<double, 3>& q,
                                   const std::array<float, 3>& gimbal) noexcept;

}  // namespace thimble::ros2
