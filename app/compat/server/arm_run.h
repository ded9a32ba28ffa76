#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compat/core/arm_channel.h"
#include "compat/server/client_force.h"
#include "compat/server/exec_options.h"
#include "compat/server/free_scene.h"
#include "compat/server/lockstep_clock.h"
#include "compat/server/reading_publisher.h"
#include "replug_watch.h"
#include "ros2/ros_run.h"
#include "run_attendance.h"
#include "share/viewer_request_handler.h"
#include "thimble/driver/result.h"
#include "thimble/session/servo_thread.h"
#include "thimble/session/session.h"

namespace thimble::compat {

/// One arm while a program uses it: a session with its own thread and the program's force.
/// Real-time: no function may be called from the servo thread.
class ArmRun {
 public:
  /// Opens arm `index` of the options and starts to run it. `number`: how many runs it had before,
  /// for the name of the recording. The error message has the remedy. `stop` ends a question to the
  /// user.
  static driver::Result<std::unique_ptr<ArmRun>> open(const ExecOptions& options, std::size_t index,
                                                      int number, ArmChannel& channel,
                                                      const std::atomic<bool>& stop);
  /// Ends the run with zero force.
  ~ArmRun();
  ArmRun(const ArmRun&) = delete;
  ArmRun& operator=(const ArmRun&) = delete;

  /// Attends to the run; call it about ten times a second. Reports a program that hangs.
  void attend(const std::string& program);
  /// Answers a pending question of the program for a Jacobian.
  void answer_joints() noexcept;
  /// Returns whether a viewer has ended the run.
  bool ended_by_viewer() const noexcept { return desk_ && desk_->ended(); }
  /// Ends the run with zero force, and returns its report: the summary of every run, and a part
  /// about the program.
  std::string end();

  /// Returns the last fault; after `end`.
  driver::Fault fault() const noexcept { return session_->device().fault(); }
  /// Returns its session, for tests.
  session::Session& session() noexcept { return *session_; }

 private:
  ArmRun(const ExecOptions& options, std::size_t index, ArmChannel& channel)
      : options_(options), index_(index), channel_(channel) {}
  driver::Result<void> prepare(int number);
  driver::Result<void> start(const std::atomic<bool>& stop);
  driver::Result<void> open_topics();
  std::string own_report() const;

  const ExecOptions& options_;
  std::size_t index_;
  ArmChannel& channel_;
  std::unique_ptr<FreeScene> free_scene_;
  std::shared_ptr<LockstepClock> paced_;
  std::unique_ptr<session::Session> session_;
  std::unique_ptr<session::ViewerRequestHandler> desk_;
  std::unique_ptr<session::ServoThread> servo_;
  std::unique_ptr<ClientForce> client_;
  std::unique_ptr<ReadingPublisher> publisher_;
  std::unique_ptr<ros2::RosRun> topics_;  // null: no topics
  std::optional<session::ReplugWatches> watch_;
  std::optional<session::RunAttendance> attendance_;
  std::atomic<bool> stop_{false};
  std::uint64_t reported_stalls_ = 0;
  bool fault_reported_ = false;
  bool begun_ = false, over_ = false;
};

}  // namespace thimble::compat
