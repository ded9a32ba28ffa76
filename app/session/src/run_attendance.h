#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "replug_watch.h"
#include "share/viewer_request_handler.h"
#include "thimble/driver/export.h"
#include "thimble/driver/tick_record.h"
#include "thimble/session/session.h"

namespace thimble::session {

/// Returns the progress of a run as a line for the terminal. `total`: s; 0 if unknown.
std::string progress_line(const driver::TickRecord& record, double total);

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
  /// `on_terminal`: standard error is a terminal.
  RunAttendance(Session& session, ReplugWatches* watch, ViewerRequestHandler* handler,
                bool on_terminal);

  /// Runs all tasks once; call it about ten times a second.
  void step();
  /// Removes the progress line after the run.
  void clear() const;

 private:
  void warn_of_compensation();

  Session& session_;
  ReplugWatches* watch_;
  ViewerRequestHandler* handler_;
  bool on_terminal_;
  double total_;  // Duration, s; 0: unknown.
  // Number of withdrawals of each arm's gravity compensation reported so far.
  std::vector<std::uint64_t> withdrawn_;
  HeatWarning heat_;
};

}  // namespace thimble::session
