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

/// Does beside the servo what viewers ask of a run: recordings begin and end, a hand that nobody
/// leads any more is let go, the run ends. Real-time: never from the servo thread.
class THIMBLE_EXPORT ViewerRequestHandler {
 public:
  /// Serves `session`, which must be shared. `viewer` is the one that was opened with the run, if
  /// any; with `ends_with_viewer` the run ends when that is closed. `next`: what begins it anew, or
  /// null; must outlive this.
  ViewerRequestHandler(Session& session, std::unique_ptr<ViewerProcess> viewer,
                       bool ends_with_viewer, NextRun* next = nullptr)
      : session_(session),
        viewer_(std::move(viewer)),
        watch_(*session.shared(), scene::run_logger(session.scene().name)),
        ends_with_viewer_(ends_with_viewer),
        next_(next) {}

  /// Looks once; call it about ten times a second.
  void step();
  /// Looks for the last time, when the run is over: what viewers ask from now on they are told that
  /// nobody hears.
  void close();

  /// Returns whether a viewer has ended the run.
  bool ended() const noexcept { return ended_; }
  /// Gives the viewer away, to who serves the run that comes next.
  std::unique_ptr<ViewerProcess> take_viewer() noexcept { return std::move(viewer_); }

 private:
  void record(const SharedRun::RecordOrder& order);
  void hear_records();
  void hear_stop();

  Session& session_;
  std::unique_ptr<ViewerProcess> viewer_;
  ViewerWatch watch_;
  bool ends_with_viewer_;
  NextRun* next_;
  bool ended_ = false;
  std::uint64_t last_order_ = 0;
};

/// Whether a run opens a viewer.
enum class ViewerChoice {
  kIfWatched,  ///< Where a person watches the run in real time.
  kAsked,      ///< Wherever there is a screen.
  kNever,
};

/// Returns whether a run opens a viewer. `terminal`: a person looks at standard error.
constexpr bool opens_viewer(ViewerChoice choice, bool real_time, bool display,
                            bool terminal) noexcept {
  if (choice == ViewerChoice::kNever || !display) return false;
  return choice == ViewerChoice::kAsked || (real_time && terminal);
}

/// Opens the viewer of a session if one is asked for, or says on standard error how to watch
/// without, and returns the handler of all viewers; null if the run is not shared.
/// `ends_with_viewer` and `next`: as for the handler; `arguments`: the viewer's, after its run.
/// Real-time: never from the servo thread.
THIMBLE_EXPORT std::unique_ptr<ViewerRequestHandler> open_viewer_requests(
    Session& session, ViewerChoice choice, bool ends_with_viewer,
    const std::vector<std::string>& arguments = {}, NextRun* next = nullptr);

}  // namespace thimble::session
