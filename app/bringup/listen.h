#pragma once

#include <atomic>
#include <cstdint>
#include <string>

#include "bringup/bench_arm.h"

namespace thimble::bringup {

/// Statistics of an arm's reports while no force was requested.
struct ReportStatistics {
  double seconds = 0;
  std::uint64_t reports = 0;
  std::uint64_t missing = 0;   ///< Ticks without a report.
  std::uint64_t skipped = 0;   ///< Reports that a newer one replaced.
  std::uint64_t rejected = 0;  ///< Reports that could not be decoded.
  std::uint64_t refused = 0;   ///< Messages that the arm did not accept.
  bool whole = false;          ///< Not ended by a fault or a stop.

  /// Returns whether a loop can run on the arm: a loop without real-time priority may miss the
  /// report in one tick of twenty.
  bool good() const { return whole && missing * 20 <= reports && rejected == 0; }
  /// Returns the counts as one sentence.
  std::string text() const;
};

/// Reads an idle arm for `seconds` with zero force. Real-time: never from the servo thread.
ReportStatistics listen(BenchArm& bench, double seconds, const std::atomic<bool>& stop);

}  // namespace thimble::bringup
