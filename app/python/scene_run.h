#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ros2/ros_run.h"
#include "ros2/ros_words.h"
#include "thimble/driver/real_time.h"
#include "thimble/driver/servo_loop.h"
#include "thimble/scene/shared_meshes.h"
#include "thimble/session/servo_thread.h"
#include "thimble/session/session.h"

namespace thimble::python {

/// What a run of a scene is asked for, as Python names it.
struct RunOptions {
  std::string scene;           ///< File or name.
  std::string arm_file;        ///< File or name; empty: the scene's own.
  std::string device = "sim";  ///< "sim", "auto" or a name (choose_arm).
  bool unchecked = false;      ///< Whole force on a real arm without a passed feel check.
  bool agreed = false;         ///< Whether the user agreed that a real arm gets forces.
  bool real_time = false;      ///< By the time of the world; always so on a real arm.
  std::optional<double> seconds = {};
  std::optional<std::uint64_t> seed = {};
  std::string quality = "normal";
  std::string record = {};    ///< HDF5 file; empty: none.
  bool overwrite = false;     ///< `record` may replace an existing recording.
  std::string firmware = {};  ///< For a real arm that needs some.
  bool homed = false;  ///< A real arm was in its home pose when it got power: do not ask for it.
  std::optional<ros2::RosWords> topics = {};  ///< Of ROS 2; in real time only.
  std::string hold_to_run = {};  ///< Button of the arm to be held for a force; empty: none.
  bool no_real_time = false;     ///< Use a real arm though the loop gets no real-time priority.
  std::shared_ptr<scene::SharedMeshes> meshes = {};  ///< That it shares with others; null: its own.
};

/// Returns what a session is opened with. Throws ThimbleError, or ArgumentError, with a sentence.
session::SessionOptions session_options(const RunOptions& options);

/// A session as Python holds it: all at once, tick by tick, or in real time on a thread of its
/// own. Every function but those of `driver::` throws ThimbleError with a sentence for the
/// user. Real-time: never from the servo thread, all of it.
class SceneRun {
 public:
  explicit SceneRun(const RunOptions& options);
  /// Ends the run as `stop` does, with zero force, and finishes its recording. What goes wrong is
  /// logged.
  ~SceneRun();
  SceneRun(const SceneRun&) = delete;
  SceneRun& operator=(const SceneRun&) = delete;

  session::Session& session() { return *session_; }
  const session::Session& session() const { return *session_; }

  /// Runs the next tick of virtual time; false if the run is over.
  bool step();
  /// Runs all that are left, and asks every 1024 ticks whether to stop early.
  void run(const std::function<bool()>& stop_asked);
  /// Runs the session in real time on a thread of its own, which asks for real-time priority.
  void start();
  /// Ends the run early, or after its time; waits for its last tick. Nothing if it is over.
  void stop();
  /// Asks the run to end with its next tick, and waits for nothing. Safe from any thread.
  void ask_to_stop() noexcept { stop_.store(true); }
  /// Returns whether a thread runs it.
  bool running() const noexcept;

  /// Returns why it ended; empty while it has not.
  std::optional<driver::ServoEnd> end() noexcept;
  /// Returns what was recorded, unless the thread runs.
  std::span<const driver::TickRecord> ticks(std::size_t arm = 0) const;
  /// Returns what there is to say of the topics of ROS 2; empty if there are none.
  std::string topics_report() const;
  /// Returns the figures of a run that is over.
  session::RunFigures figures(std::size_t arm = 0);

 private:
  bool take_step();
  void finish();

  std::unique_ptr<session::Session> session_;
  std::atomic<bool> stop_{false};
  bool busy_ = false;  // a step or a run is under way; guarded by Python's own lock
  bool finished_ = false;
  std::optional<driver::ServoEnd> end_;
  driver::RealTimeGrant grant_;
  std::optional<ros2::RosOptions> asked_topics_;
  std::vector<std::unique_ptr<ros2::RosRun>> topics_;  // of each arm; they end before the session
  std::unique_ptr<session::ServoThread> servo_;        // in real time
};

}  // namespace thimble::python
