#include "cli/options/ros_options.h"

#include <utility>

namespace thimble::cli {

void add_ros_options(CLI::App& command, RosArguments& arguments, RosTime time) {
  const std::string how = time == RosTime::kRealOrStepped
                              ? ", in real time or, with --clock virtual, as the topic step moves "
                                "it on"
                              : ", in real time";
  CLI::Option* ros2 =
      command.add_flag("--ros2", arguments.asked,
                       "Publish the run as topics of ROS 2" + how + " (package thimble-ros2)");
  command
      .add_option("--ros-namespace", arguments.words.name_space,
                  "Namespace of the topics, as /phantom; none if absent (omni: /phantom)")
      ->needs(ros2);
  command
      .add_option("--ros-names", arguments.words.names,
                  "plain: pose, twist, wrench, joint_states; crtk: measured_cp, measured_cv, "
                  "body/measured_cf, measured_js; omni: as the Omni's drivers, with their axes and "
                  "joints")
      ->check(CLI::IsMember({"plain", "crtk", "omni"}))
      ->capture_default_str()
      ->needs(ros2);
  command.add_option("--ros-domain", arguments.words.domain, "ROS_DOMAIN_ID of the topics")
      ->check(CLI::Range(0, 232))
      ->capture_default_str()
      ->needs(ros2);
  command
      .add_flag("--ros-network", arguments.words.network,
                "Let other computers see the topics and, with --ros-force, give forces; without it "
                "only programs of this one can")
      ->needs(ros2);
  command
      .add_option(
          "--ros-force", arguments.words.force,
          "add: forces of the topic command/wrench (crtk: body/servo_cf, omni: force_feedback) "
          "are added to the scene's; replace: they stand in its place; none: nobody listens")
      ->check(CLI::IsMember({"none", "add", "replace"}))
      ->capture_default_str()
      ->needs(ros2);
  command
      .add_option("--ros-limit", arguments.words.force_limit,
                  "Largest force of that topic, N; the arm's own limit if absent or larger")
      ->check(CLI::Range(1e-3, 1e3))
      ->needs(ros2);
  command
      .add_option("--ros-stale", arguments.words.stale_ms,
                  "A force of that topic counts for so many milliseconds, then it is zero")
      ->check(CLI::Range(1.0, 1000.0))
      ->capture_default_str()
      ->needs(ros2);
  command
      .add_option("--ros-frames", arguments.words.frames,
                  "Names of the frames of the world and of the tip, with a comma between")
      ->capture_default_str()
      ->needs(ros2);
}

driver::Result<void> check_ros_arguments(RosArguments& arguments) {
  if (!arguments.asked) return {};
  auto options = ros2::ros_options(arguments.words);
  if (!options) return options.error();
  arguments.options = std::move(options).value();
  return {};
}

}  // namespace thimble::cli
