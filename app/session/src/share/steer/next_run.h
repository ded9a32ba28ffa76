#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "share/steer/file_watch.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/driver/servo_loop.h"
#include "thimble/session/session.h"

namespace thimble::session {

/// Prepares the run that follows a run of simulated arms: the same scene from its first tick, or
/// another one. Viewers, changed files or the end of the run trigger it. It is prepared while the
/// current run continues; if preparation fails, the current run is not affected. Real-time: never
/// from the servo thread.
class THIMBLE_EXPORT NextRun {
 public:
  /// Function that prepares a session of a scene file without viewers and recording.
  using Prepare =
      std::function<driver::Result<std::unique_ptr<Session>>(const std::filesystem::path& scene)>;

  /// Constructs it with a function that prepares sessions. `reload`: restart when the scene or arm
  /// file changes. `loop`: restart at the end of the run. `speed`: multiple of real time. Viewers
  /// can change `loop` and `speed`.
  NextRun(Prepare prepare, bool reload, bool loop, double speed)
      : prepare_(std::move(prepare)), reload_(reload), loop_(loop), speed_(speed) {}

  /// Serves `session`, which is shared, from now on. A run with a real arm is never restarted: then
  /// no function has an effect.
  void begin(Session& session);
  /// Processes requests; call it about ten times a second. Prepares the requested run, or reports
  /// the error to viewers. Once a run is prepared, the current one is closed to requests of viewers
  /// (SharedRun::close), which then address the next one. `stop`: the run must end without a next
  /// one.
  void step(bool stop);
  /// Returns whether the run restarts when it has ended, as asked last.
  bool loops() const noexcept { return loop_; }
  /// Returns whether a loop has ended because its files can no longer be used: a mesh is read again
  /// for each run.
  bool failed() const noexcept { return failed_; }
  /// Returns the flag that ends the current run.
  const std::atomic<bool>& ended() const noexcept { return end_; }
  /// Returns the next run after the current one has ended with `end`: the prepared one, the last
  /// one that a viewer requested, or the same scene if `loops`. If its files can no longer be used,
  /// the loop continues with the scene as read before, unless a mesh has changed too. Null: none.
  /// An error of preparation is logged and reported to viewers. The current run is closed to
  /// requests of viewers.
  std::unique_ptr<Session> take(driver::ServoEnd end, bool stop);

 private:
  /// Prepares a scene. Returns whether it succeeded. `continues`: if it fails, the run continues or
  /// restarts nevertheless, and the messages say so.
  bool prepare(const std::filesystem::path& scene, bool continues);
  bool prepare_as_read();
  bool prepare_requested(bool continues);
  bool prepare_changed();
  void update_pace();

  Prepare prepare_;
  bool reload_;
  bool loop_;
  double speed_;
  Session* session_ = nullptr;  // Null: the run cannot be restarted.
  std::filesystem::path scene_;
  FileWatch files_;
  std::uint64_t last_request_ = 0;
  std::unique_ptr<Session> next_;
  bool pause_ = false;  // Pause requested of a run that has ended, to be applied to the next one.
  std::string last_error_;  // Last logged error of a preparation; empty after a success.
  std::string notice_;      // Reason why the last request is not the next run; empty if it is.
  std::atomic<bool> end_{false};
  bool failed_ = false;
};

}  // namespace thimble::session
