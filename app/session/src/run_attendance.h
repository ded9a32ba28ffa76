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

/// Returns how far a run is, in a line for the terminal. `total`: s; 0 if unknown.
std::string progress_line(const driver::TickRecord& record, double total);

/// A warning about the heat of an arm's motors, given once in a run.
class HeatWarning {
 public:
  /// Returns the warning with the first tick that is so hot; empty otherwise.
  std::string look(const driver::TickRecord& record);

 private:
  bool given_ = false;
};

/// Writes the seconds around the faults of all arms (Session::keep_black_boxes), and logs where a
/// person finds them, or why not. Real-time: never from the servo thread.
THIMBLE_EXPORT void keep_black_boxes(Session& session, bool run_is_over);

/// What is done beside the servo while a run goes on: a pulled arm is watched for, viewers are
/// heard, the black box is emptied, and the user is told of heat and progress. Real-time: never
/// from the servo thread.
class THIMBLE_EXPORT RunAttendance {
 public:
  /// Attends a session; `watch` and `desk` may be null, and must outlive it. `on_terminal`: a
  /// person looks at standard error.
  RunAttendance(Session& session, ReplugWatches* watch, ViewerRequestHandler* desk,
                bool on_terminal);

  /// Looks once; call it about ten times a second.
  void step();
  /// Takes the line of progress away, after the run.
  void clear() const;

 private:
  void warn_of_carried();

  Session& session_;
  ReplugWatches* watch_;
  ViewerRequestHandler* desk_;
  bool on_terminal_;
  double total_;                          // s; 0: unknown
  std::vector<std::uint64_t> withdrawn_;  // of each arm's carried force, as was reported
  HeatWarning heat_;
};

}  // namespace thimble::session
