#pragma once

#include <CLI/CLI.hpp>

#include "ros2/ros_option_strings.h"
#include "thimble/driver/result.h"

namespace thimble::cli {

/// The arguments --ros2... of a command.
struct RosArguments {
  bool asked = false;
  ros2::RosOptionStrings words;
  ros2::RosOptions options;  ///< The parsed options; see check_ros_arguments.
};

/// The kinds of time that the topics of a command support.
enum class RosTime { kReal, kRealOrStepped };

/// Details of the options --ros2... for the end of a command's help.
inline constexpr const char* kRosNotes =
    "--ros-names  plain: pose, twist, wrench, joint_states. crtk: measured_cp,\n"
    "             measured_cv, body/measured_cf, measured_js. omni: names, axes\n"
    "             and joints of the Omni drivers.\n"
    "--ros-force  Topic command/wrench (crtk: body/servo_cf, omni: force_feedback).\n"
    "             add: added to the force of the scene; replace: sent instead of it.\n"
    "--ros-network  Without it, only programs on this computer can use the topics.";

/// Adds the options of a run as ROS 2 topics. The arguments must outlive the command.
void add_ros_options(CLI::App& command, RosArguments& arguments, RosTime time);

/// Parses the arguments into their options; fails if they contradict each other.
driver::Result<void> check_ros_arguments(RosArguments& arguments);

}  // namespace thimble::cli
