#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "ros2/ros_peer.h"
#include "thimble/driver/device.h"

namespace thimble::session {
class Session;
}

namespace thimble::compat {

/// One arm that a program gets.
struct ExecArm {
  std::string device = "sim";  ///< "sim", "auto", or a name that `thimble devices` lists.
  std::string arm_file = {};   ///< Name or path; empty: the scene's own, or that of a real arm.
};

/// What a user wants of `thimble exec`.
struct ExecOptions {
  std::string program = {};           ///< What is started, for the report and the viewer.
  std::vector<ExecArm> arms = {{}};   ///< In the order in which the program numbers them.
  std::string scene = {};             ///< Name or path; empty: nothing but what the program draws.
  std::string hand = "path";          ///< "path": the scene's; "mouse"; or a file (hand_path.h).
  std::filesystem::path record = {};  ///< Recording of every tick; empty: none.
  bool overwrite = false;             ///< `record` may replace existing recordings.
  std::filesystem::path firmware = {};  ///< For a real arm that needs some.
  /// Ticks wait for the program: the same result each time, as fast as it goes. Only with simulated
  /// arms, and without a viewer.
  bool paced = false;
  std::optional<ros2::RosOptions> topics = {};  ///< Of ROS 2; not with `paced`.
  bool view = false;                            ///< Watch the run in a window.
  bool yes = false;                             ///< Give a real arm forces without asking.
  bool unchecked = false;                       ///< Its whole force without a passed feel check.
  bool homed = false;                           ///< It was in its home pose when it got power.
  bool no_real_time = false;                    ///< Without real-time priority.
  driver::HoldToRun hold = {};                  ///< Buttons of the arm to be held for a force.
  /// Called with an arm's number and session before its loop begins, for tests.
  std::function<void(std::size_t, session::Session&)> opened = {};
};

}  // namespace thimble::compat
