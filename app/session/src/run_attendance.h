#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "log/progress.h"
#include "replug_watch.h"
#include "share/viewer_request_handler.h"
#include "thimble/driver/export.h"
#include "thimble/driver/tick_record.h"
#include "thimble/session/session.h"

namespace thimble::session {

/// Returns the state of a run for its progress. `total`: s; 0 if unknown.
std::string run_state(const driver::TickRecord& record, double total);

/// Warning about the heat of an arm's motors, given once per run.
class HeatWarning {
 public:
  /// Returns the warning at the first tick above the limit; empty otherwise.
  std::string check(const driver::TickRecord& record);

 private:
  bool given_ = false;
};

/// Writes the seconds around the faults of all arms (Session::keep_black_boxes), and logs the file
/// names or the error. Real-time: never from the servo thread.
THIMBLE_EXPORT void keep_black_boxes(Session& session, bool run_is_over);

/// Tasks outside of the servo loop during a run: detects a reconnected arm, handles requests of
/// viewers, writes the black box, and reports heat and progress to the user. Real-time: never from
/// the servo thread.
class THIMBLE_EXPORT RunAttendance {
 public:
  /// Constructs the tasks of a session. `watch` and `desk` may be null, and must outlive it.
  /// `shows_progress`: progress is shown as the process has chosen (scene::choose_progress).
  RunAttendance(Session& session, ReplugWatches* watch, ViewerRequestHandler* handler,
                bool shows_progress);

  /// Runs all tasks once; call it about ten times a second.
  void step();
  /// Ends the progress after the run.
  void clear();

 private:
  void warn_of_compensation();
  void show(const driver::TickRecord& record);

  Session& session_;
  ReplugWatches* watch_;
  ViewerRequestHandler* handler_;
  double total_;  // Duration, s; 0: unknown.
  std::optional<scene::Progress> progress_;
  // Number of withdrawals of each arm's gravity compensation reported so far.
  std::vector<std::uint64_t> withdrawn_;
  HeatWarning heat_;
};

}  // namespace thimble::session
