#include "ros2/ros_names.h"

#include <cctype>
#include <numbers>
#include <set>

namespace thimble::ros2 {

const RosNames& ros_names(RosStyle style) noexcept {
  static constexpr RosNames kPlain{.joints = "joint_states",
                                   .pose = "pose",
                                   .twist = "twist",
                                   .wrench = "wrench",
                                   .buttons = "button",
                                   .state = nullptr,
                                   .robot = "robot_description",
                                   .force_in = "command/wrench",
                                   .hand_in = "command/pose"};
  static constexpr RosNames kCrtk{.joints = "measured_js",
                                  .pose = "measured_cp",
                                  .twist = "measured_cv",
                                  .wrench = "body/measured_cf",
                                  .buttons = "button",
                                  .state = nullptr,
                                  .robot = "robot_description",
                                  .force_in = "body/servo_cf",
                                  .hand_in = "servo_cp"};
  static constexpr RosNames kOmni{.joints = "joint_states",
                                  .pose = "pose",
                                  .twist = "twist",
                                  .wrench = "wrench",
                                  .buttons = "button",
                                  .state = "state",
                                  .robot = nullptr,
                                  .force_in = "force_feedback",
                                  .hand_in = "command/pose"};
  switch (style) {
    case RosStyle::kCrtk:
      return kCrtk;
    case RosStyle::kOmni:
      return kOmni;
    case RosStyle::kPlain:
      break;
  }
  return kPlain;
}

std::string frame_name_of(const std::string& text) {
  std::string word;
  for (const char c : text) word += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  return word.empty() ? "_" : word;
}

std::vector<std::string> object_frames(const std::vector<std::string>& names) {
  std::vector<std::string> frames;
  std::set<std::string> used;
  for (const std::string& name : names) {
    const std::string frame = "object_" + frame_name_of(name);
    std::string own = frame;
    for (int number = 2; !used.insert(own).second; ++number) {
      own = frame + "_" + std::to_string(number);
    }
    frames.push_back(own);
  }
  return frames;
}

std::array<double, 3> to_style(RosStyle style, const std::array<double, 3>& v_W) noexcept {
  if (style != RosStyle::kOmni) return v_W;
  return {v_W[1], -v_W[0], v_W[2]};
}

std::array<double, 3> from_style(RosStyle style, const std::array<double, 3>& v) noexcept {
  if (style != RosStyle::kOmni) return v;
  return {-v[1], v[0], v[2]};
}

std::array<double, 4> to_style(RosStyle style, const std::array<double, 4>& q_W) noexcept {
  if (style != RosStyle::kOmni) return q_W;
  // A quarter turn back about z, applied first: (c, 0, 0, -c) q with c = sqrt(1/2).
  constexpr double c = std::numbers::sqrt2 / 2;
  const auto& [w, x, y, z] = q_W;
  return {c * (w + z), c * (x + y), c * (y - x), c * (z - w)};
}

std::vector<std::string> joint_names(RosStyle style, std::size_t count) {
  std::vector<std::string> names;
  if (style == RosStyle::kOmni) {
    names = {"waist", "shoulder", "elbow", "yaw", "pitch", "roll"};
  } else {
    names = {"joint1", "joint2", "joint3", "gimbal1", "gimbal2", "gimbal3"};
  }
  names.resize(count);
  return names;
}

std::array<double, 6> joint_angles(RosStyle style, const std::array<double, 3>& q,
                                   const std::array<float, 3>& gimbal) noexcept {
  constexpr double kPi = std::numbers::pi;
  const std::array<double, 3> g{static_cast<double>(gimbal[0]), static_cast<double>(gimbal[1]),
                                static_cast<double>(gimbal[2])};
  if (style != RosStyle::kOmni) return {q[0], q[1], q[2], g[0], g[1], g[2]};
  return {-q[0], q[1], q[2] - q[1], kPi - g[0], -0.75 * kPi - g[1], -kPi - g[2]};
}

}  // namespace thimble::ros2
