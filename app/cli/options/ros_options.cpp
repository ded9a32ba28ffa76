#include "cli/options/ros_options.h"

#include <utility>

namespace thimble::cli {

void add_ros_options(CLI::App& command, RosArguments& arguments, RosTime time) {
  constexpr const char* kTopic = "ROS 2 (package thimble-ros2)";
  CLI::Option* ros2 = command
                          .add_flag("--ros2", arguments.asked,
                                    time == RosTime::kRealOrStepped
                                        ? "Publish topics, in real time or stepped by topic `step`"
                                        : "Publish the run as topics, in real time")
                          ->group(kTopic);
  command
      .add_option("--ros-namespace", arguments.words.name_space,
                  "Namespace of the topics (default: none; omni: /phantom)")
      ->option_text("NAME")
      ->needs(ros2)
      ->group(kTopic);
  command.add_option("--ros-names", arguments.words.names, "Naming scheme of the topics")
      ->check(CLI::IsMember({"plain", "crtk", "omni"}))
      ->capture_default_str()
      ->needs(ros2)
      ->group(kTopic);
  command.add_option("--ros-domain", arguments.words.domain, "ROS_DOMAIN_ID of the topics")
      ->check(CLI::Range(0, 232))
      ->capture_default_str()
      ->needs(ros2)
      ->group(kTopic);
  command
      .add_flag("--ros-network", arguments.words.network,
                "Allow other computers to use topics and --ros-force")
      ->needs(ros2)
      ->group(kTopic);
  command
      .add_option("--ros-force", arguments.words.force,
                  "Ignore received forces, add them, or send only them")
      ->check(CLI::IsMember({"none", "add", "replace"}))
      ->capture_default_str()
      ->needs(ros2)
      ->group(kTopic);
  command
      .add_option("--ros-limit", arguments.words.force_limit,
                  "Largest received force, N (default: the arm's limit)")
      ->check(CLI::Range(1e-3, 1e3))
      ->needs(ros2)
      ->group(kTopic);
  command
      .add_option("--ros-stale", arguments.words.stale_ms,
                  "Age at which a received force becomes zero, ms")
      ->check(CLI::Range(1.0, 1000.0))
      ->capture_default_str()
      ->needs(ros2)
      ->group(kTopic);
  command
      .add_option("--ros-frames", arguments.words.frames, "Frame ids of the world and of the tip")
      ->option_text("WORLD,TIP")
      ->capture_default_str()
      ->needs(ros2)
      ->group(kTopic);
}

driver::Result<void> check_ros_arguments(RosArguments& arguments) {
  if (!arguments.asked) return {};
  auto options = ros2::ros_options(arguments.words);
  if (!options) return options.error();
  arguments.options = std::move(options).value();
  return {};
}

}  // namespace thimble::cli
