#pragma once

#include <atomic>
#include <cstdint>
#include <string>

#include "bringup/bench_arm.h"

namespace thimble::bringup {

/// How well an arm's reports arrived while nothing was asked of it.
struct Listened {
  double seconds = 0;
  std::uint64_t reports = 0;
  std::uint64_t missing = 0;   ///< Ticks without a report.
  std::uint64_t skipped = 0;   ///< Reports that a newer one overtook.
  std::uint64_t rejected = 0;  ///< Reports that could not be understood.
  std::uint64_t refused = 0;   ///< Messages that the arm did not take.
  bool whole = false;          ///< No fault and no stop ended it.

  /// Returns whether a loop can run on it: one tick in twenty without a report is what a loop
  /// without real-time priority may cost.
  bool good() const { return whole && missing * 20 <= reports && rejected == 0; }
  /// Returns one sentence with the counts.
  std::string text() const;
};

/// Reads an idle arm for `seconds` with zero force. Real-time: never from the servo thread.
Listened listen(BenchArm& bench, double seconds, const std::atomic<bool>& stop);

}  // namespace thimble::bringup
