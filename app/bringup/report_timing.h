#pragma once

#include <atomic>
#include <cstddef>
#include <vector>

#include "bringup/bench_arm.h"
#include "bringup/estimate.h"

namespace thimble::bringup {

/// Regularity of an arm's reports as the host sees it: combined effect of the arm's clock, the bus
/// and the host's wake-up.
struct ReportTiming {
  Estimate period;          ///< Time between reports, s; 0: too few came.
  Estimate jitter;          ///< RMS deviation of their times, s.
  double latest = 0;        ///< Max. delay of a report after its regular time, s.
  std::size_t reports = 0;  ///< Number of timed reports.
  std::size_t missing = 0;  ///< Number of missing reports between them.
  /// The jitter is so large that a late report cannot be distinguished from a missing one.
  bool blurred = false;
};

/// Returns the timing of reports that arrived at these times (s), in their order. Real-time: never
/// from the servo thread.
ReportTiming timing_of(const std::vector<double>& times);

/// Waits for the reports of an idle arm one by one, for `seconds`. Each is answered with zero
/// force, so that an arm that sends only when asked continues. Real-time: never from the servo
/// thread.
ReportTiming time_reports(BenchArm& bench, double seconds, const std::atomic<bool>& stop);

}  // namespace thimble::bringup
