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

/// What comes after a run of simulated arms: the same scene from its first tick, or another one, as
/// viewers ask, as its files change, or as the run comes to its end. What is next is prepared
/// beside the run, which goes on where that fails. Real-time: never from the servo thread.
class THIMBLE_EXPORT NextRun {
 public:
  /// Prepares a session of a scene's file that nobody sees yet, and records nothing.
  using Prepare =
      std::function<driver::Result<std::unique_ptr<Session>>(const std::filesystem::path& scene)>;

  /// Prepares by `prepare`. `reload`: the run begins anew when its scene's or arm's file changes;
  /// `loop`: when it has ended, and `speed`: times real time, until a viewer wants it otherwise.
  NextRun(Prepare prepare, bool reload, bool loop, double speed)
      : prepare_(std::move(prepare)), reload_(reload), loop_(loop), speed_(speed) {}

  /// Serves `session` from now on, which is shared. A run with a real arm is none to begin anew:
  /// then nothing here does anything.
  void begin(Session& session);
  /// Looks once, about ten times a second: what is asked for is prepared, or the viewers are told
  /// why not. As soon as it is, the run is closed to what viewers ask (SharedRun::close): they ask
  /// the next one. `stop`: the run shall end and nothing shall come after it.
  void step(bool stop);
  /// Returns whether the run restarts when it has ended, as asked last.
  bool loops() const noexcept { return loop_; }
  /// Returns the flag that ends the run that is served.
  const std::atomic<bool>& ended() const noexcept { return end_; }
  /// Returns what to run next, after the run has ended by `end`: what was prepared, what a viewer
  /// has asked for last, or the same scene once more where it loops. Null: nothing. What cannot be
  /// prepared is told in the log, and to the viewers. The run is closed to what viewers ask.
  std::unique_ptr<Session> take(driver::ServoEnd end, bool stop);

 private:
  bool prepare(const std::filesystem::path& scene);
  bool prepare_ordered();
  bool prepare_changed();
  void hear_pace();

  Prepare prepare_;
  bool reload_;
  bool loop_;
  double speed_;
  Session* session_ = nullptr;  // null: there is nothing to begin anew
  std::filesystem::path scene_;
  FileWatch files_;
  std::uint64_t last_order_ = 0;
  std::unique_ptr<Session> next_;
  bool pause_ = false;  // asked of a run that ended by itself, and of what is next
  std::string notice_;  // why what was asked for last is not what is next; empty: it is
  std::atomic<bool> end_{false};
};

}  // namespace thimble::session
