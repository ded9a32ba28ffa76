#pragma once

#include <CLI/CLI.hpp>

#include "ros2/ros_words.h"
#include "thimble/driver/result.h"

namespace thimble::cli {

/// What the arguments --ros2... of a command say.
struct RosArguments {
  bool asked = false;
  ros2::RosWords words;
  ros2::RosOptions options;  ///< What they mean; see check_ros_arguments.
};

/// Which time the topics of a command may have.
enum class RosTime { kReal, kRealOrStepped };

/// Adds the options of a run as ROS 2 topics. The arguments must outlive the command.
void add_ros_options(CLI::App& command, RosArguments& arguments, RosTime time);

/// Reads the words among the arguments into their options; fails if they do not go together.
driver::Result<void> check_ros_arguments(RosArguments& arguments);

}  // namespace thimble::cli
