#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "hand/button_plan.h"
#include "ros2/ros_peer.h"
#include "thimble/driver/device.h"

namespace thimble::session {
class Session;
}

namespace thimble::compat {

/// One arm of a program.
struct ExecArm {
  std::string device = "sim";  ///< "sim", "auto", or a name from `thimble devices`.
  std::string arm_file = {};   ///< Name or path; empty: that of the scene, or of a real arm.
};

/// Options of `thimble exec`.
struct ExecOptions {
  std::string program = {};          ///< The started program, for the report and the viewer.
  std::vector<ExecArm> arms = {{}};  ///< In the program's numbering.
  std::string scene = {};            ///< Name or path; empty: no objects.
  std::string hand = "path";         ///< "path": the scene's; "free"; "mouse"; or a file.
  std::vector<scene::ButtonPress> presses = {};  ///< Presses of buttons of simulated arms.
  std::filesystem::path record = {};             ///< Recording of every tick; empty: none.
  bool overwrite = false;                        ///< `record` may replace existing recordings.
  std::filesystem::path firmware = {};           ///< For a real arm that needs firmware.
  /// Ticks wait for the program: results are repeatable, and the run is as fast as possible. Only
  /// with simulated arms, and without a viewer.
  bool paced = false;
  std::optional<ros2::RosOptions> topics = {};  ///< ROS 2 topics; not with `paced`.
  bool view = false;                            ///< Show the run in a window.
  std::string theme = {};                       ///< Of the window: light, dark; empty: light.
  bool yes = false;                             ///< Enable forces of a real arm without asking.
  bool unchecked = false;                       ///< Allow full force without a passed feel check.
  bool homed = false;                           ///< The arm was in its home pose at power-up.
  bool no_real_time = false;                    ///< Run without real-time priority.
  driver::HoldToRun hold = {};                  ///< Arm's buttons that must be held for a force.
  /// Called with an arm's number and session before its loop begins, for tests.
  std::function<void(std::size_t, session::Session&)> opened = {};
};

}  // namespace thimble::compat
