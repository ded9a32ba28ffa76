#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ros2/ros_option_strings.h"
#include "ros2/ros_run.h"
#include "thimble/driver/real_time.h"
#include "thimble/driver/servo_loop.h"
#include "thimble/scene/shared_meshes.h"
#include "thimble/session/servo_thread.h"
#include "thimble/session/session.h"

namespace thimble::python {

/// Options of a run, as in Python.
struct RunOptions {
  std::string scene;           ///< File or name.
  std::string arm_file;        ///< File or name; empty: that of the scene.
  std::string device = "sim";  ///< "sim", "auto" or a name (choose_arm).
  bool unchecked = false;      ///< Allow full force on a real arm without a passed feel check.
  bool agreed = false;         ///< Whether the user agreed to forces of a real arm.
  bool real_time = false;      ///< Uses wall-clock time; always on a real arm.
  std::optional<double> seconds = {};
  std::optional<std::uint64_t> seed = {};
  std::string quality = "normal";
  std::string record = {};    ///< HDF5 file; empty: none.
  bool overwrite = false;     ///< `record` may replace an existing recording.
  std::string firmware = {};  ///< For a real arm that needs firmware.
  bool homed = false;         ///< A real arm was in its home pose at power-up: do not ask for it.
  std::optional<ros2::RosOptionStrings> topics = {};  ///< ROS 2 topics; only in real time.
  std::string hold_to_run = {};  ///< Button of the arm that must be held for a force; empty: none.
  bool no_real_time = false;     ///< Use a real arm although the loop gets no real-time priority.
  std::shared_ptr<scene::SharedMeshes> meshes = {};  ///< Shared with other runs; null: its own.
};

/// Returns the options of a session. Throws ThimbleError or ArgumentError.
session::SessionOptions session_options(const RunOptions& options);

/// A session for Python: runs as a whole, tick by tick, or in real time on its own thread. All
/// functions except those of `driver::` throw ThimbleError with a message for the user. Real-time:
/// no function may be called from the servo thread.
class SceneRun {
 public:
  explicit SceneRun(const RunOptions& options);
  /// Ends the run like `stop`, with zero force, and finishes its recording. Errors are logged.
  ~SceneRun();
  SceneRun(const SceneRun&) = delete;
  SceneRun& operator=(const SceneRun&) = delete;

  session::Session& session() { return *session_; }
  const session::Session& session() const { return *session_; }

  /// Runs the next tick of virtual time; false if the run is over.
  bool step();
  /// Runs all remaining ticks; checks every 1024 ticks whether to stop early.
  void run(const std::function<bool()>& stop_asked);
  /// Runs the session in real time on its own thread, which requests real-time priority.
  void start();
  /// Ends the run and waits for its last tick. Does nothing if it has ended.
  void stop();
  /// Requests that the run end with its next tick, without waiting. Safe from any thread.
  void ask_to_stop() noexcept { stop_.store(true); }
  /// Returns whether its thread is running.
  bool running() const noexcept;

  /// Returns why the run ended; empty if it has not.
  std::optional<driver::ServoEnd> end() noexcept;
  /// Returns the recorded ticks, unless the thread is running.
  std::span<const driver::TickRecord> ticks(std::size_t arm = 0) const;
  /// Returns the report on the ROS 2 topics; empty if there are none.
  std::string topics_report() const;
  /// Returns the figures of a finished run.
  session::RunFigures figures(std::size_t arm = 0);

 private:
  bool take_step();
  void finish();

  std::unique_ptr<session::Session> session_;
  std::atomic<bool> stop_{false};
  bool busy_ = false;  // a step or a run is in progress; guarded by Python's GIL
  bool finished_ = false;
  std::optional<driver::ServoEnd> end_;
  driver::RealTimeGrant grant_;
  std::optional<ros2::RosOptions> asked_topics_;
  std::vector<std::unique_ptr<ros2::RosRun>> topics_;  // one per arm; must end before the session
  std::unique_ptr<session::ServoThread> servo_;        // for real time
};

}  // namespace thimble::python
