#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "log/logger.h"
#include "share/shared_run.h"
#include "share/steer/next_run.h"
#include "share/viewer_process.h"
#include "share/viewer_watch.h"
#include "thimble/driver/export.h"
#include "thimble/scene/scene_file.h"
#include "thimble/session/session.h"

namespace thimble::session {

/// Handles requests of viewers outside of the servo loop: starts and ends recordings, releases a
/// hand that is no longer moved, and ends the run. Real-time: never from the servo thread.
class THIMBLE_EXPORT ViewerRequestHandler {
 public:
  /// Constructs a handler for `session`, which must be shared. `viewer` is the one opened with the
  /// run, if any; with `ends_with_viewer` the run ends when it is closed. `next` restarts the run,
  /// or is null; it must outlive this.
  ViewerRequestHandler(Session& session, std::unique_ptr<ViewerProcess> viewer,
                       bool ends_with_viewer, NextRun* next = nullptr)
      : session_(session),
        viewer_(std::move(viewer)),
        watch_(*session.shared(), scene::run_logger(session.scene().name)),
        ends_with_viewer_(ends_with_viewer),
        next_(next) {}

  /// Processes requests once; call it about ten times a second.
  void step();
  /// Processes requests for the last time, after the run. Later requests of viewers are rejected.
  void close();

  /// Returns whether a viewer has ended the run.
  bool ended() const noexcept { return ended_; }
  /// Releases the viewer, for the handler of the next run.
  std::unique_ptr<ViewerProcess> take_viewer() noexcept { return std::move(viewer_); }

 private:
  void record(const SharedRun::RecordRequest& order);
  void handle_record_requests();
  void handle_stop_request();

  Session& session_;
  std::unique_ptr<ViewerProcess> viewer_;
  ViewerWatch watch_;
  bool ends_with_viewer_;
  NextRun* next_;
  bool ended_ = false;
  std::uint64_t last_request_ = 0;
};

/// Choice of opening a viewer with a run.
enum class ViewerChoice {
  kIfWatched,  ///< If a user watches the run in real time.
  kAsked,      ///< If a display is available.
  kNever,
};

/// Returns whether a run opens a viewer. `terminal`: standard error is a terminal.
constexpr bool opens_viewer(ViewerChoice choice, bool real_time, bool display,
                            bool terminal) noexcept {
  if (choice == ViewerChoice::kNever || !display) return false;
  return choice == ViewerChoice::kAsked || (real_time && terminal);
}

/// Opens the viewer of a session if requested, or prints on standard error how to watch without
/// one. Returns the handler of all viewers; null if the run is not shared. `ends_with_viewer` and
/// `next`: as for the handler; `arguments`: additional arguments of the viewer. Real-time: never
/// from the servo thread.
THIMBLE_EXPORT std::unique_ptr<ViewerRequestHandler> open_viewer_requests(
    Session& session, ViewerChoice choice, bool ends_with_viewer,
    const std::vector<std::string>& arguments = {}, NextRun* next = nullptr);

}  // namespace thimble::session
