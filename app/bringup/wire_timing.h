#pragma once

#include <atomic>
#include <cstddef>
#include <optional>

#include "thimble/driver/clock.h"
#include "thimble/driver/transport.h"
#include "wires/wire_table.h"

namespace thimble::bringup {

/// Timing of the reports of a described board, as this computer sees it.
struct WireTiming {
  std::size_t reports = 0;  ///< Valid reports.
  /// Messages that are no valid reports. Their sequence numbers do not count as lost.
  std::size_t damaged = 0;
  /// Valid reports whose error flags make them unusable; they are part of `reports`.
  std::size_t unusable = 0;
  std::optional<std::size_t> lost;      ///< Missing sequence numbers; empty without numbers.
  std::optional<std::size_t> repeated;  ///< Reports whose number does not increase; as `lost`.
  std::size_t unanswered = 0;           ///< Commands without an answer, if the board is asked.
  bool disconnected = false;            ///< The port was lost.
  double duration = 0;                  ///< Time from the first report to the last, s.
  double rate = 0;                      ///< Reports per second.
  /// Time between two reports, or between a command and its answer, s: mean, the value that 99 % do
  /// not exceed, and the largest one.
  double mean = 0, p99 = 0, max = 0;
  driver::WireVerdict flaw{};  ///< Flaw of the last damaged message, if it is known.
};

/// Listens to a board that streams, for `seconds` from its first report, and sends nothing. Waits
/// at most 3 s for the first report. Real-time: never from the servo thread.
WireTiming time_stream(driver::Transport& port, const driver::WireTable& wire,
                       const driver::Clock& clock, double seconds, const std::atomic<bool>& stop);

/// Asks a board for reports by commands of zero force, each after the answer to the last one, for
/// `seconds`. Precondition: its identity is proven (open_described). Real-time: never from the
/// servo thread.
WireTiming time_answers(driver::Transport& port, const driver::WireTable& wire,
                        const driver::Clock& clock, double seconds, const std::atomic<bool>& stop);

}  // namespace thimble::bringup
