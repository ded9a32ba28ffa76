#pragma once

#include <atomic>
#include <cstddef>
#include <vector>

#include "bringup/bench_arm.h"
#include "bringup/estimate.h"

namespace thimble::bringup {

/// How regularly an arm's reports come, as the host sees it: what the arm's clock, the bus and the
/// host's own waking up make together.
struct ReportTiming {
  Estimate period;          ///< s, from report to report; 0: too few came.
  Estimate jitter;          ///< RMS of how late or early they come, s.
  double latest = 0;        ///< The latest one, after its even time, s.
  std::size_t reports = 0;  ///< That were timed.
  std::size_t missing = 0;  ///< That should have come between them and did not.
  /// It is so large that a late report and a missing one cannot be told apart.
  bool blurred = false;
};

/// Returns the timing of reports that came at these times (s), in their order. Real-time: never
/// from the servo thread.
ReportTiming timing_of(const std::vector<double>& times);

/// Waits for the reports of an idle arm one by one, for `seconds`; each is answered by zero force,
/// so that one that speaks only when spoken to goes on. Real-time: never from the servo thread.
ReportTiming time_reports(BenchArm& bench, double seconds, const std::atomic<bool>& stop);

}  // namespace thimble::bringup
