#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "report/html/page_block.h"
#include "thimble/driver/tick_record.h"

namespace thimble::report {

/// Ticks of one arm, and the time from the tick before each of them to it.
struct PageTicks {
  PageTicks() = default;
  /// Takes ticks as they are.
  PageTicks(std::span<const driver::TickRecord> all) : ticks(all) {}     // NOLINT(*-explicit-*)
  PageTicks(const std::vector<driver::TickRecord>& all) : ticks(all) {}  // NOLINT(*-explicit-*)
  /// Takes ticks of which some are missing: `periods` (ns) belong to them, one each.
  PageTicks(std::span<const driver::TickRecord> some, std::span<const std::int64_t> periods)
      : ticks(some), periods_ns(periods) {}

  /// Returns the time since the tick before tick `i`, ns; that of the second for the first. Without
  /// `periods_ns` it is the mean where ticks are missing before it.
  std::int64_t period_ns(std::size_t i) const noexcept;

  std::span<const driver::TickRecord> ticks;
  std::span<const std::int64_t> periods_ns;  ///< Empty: the differences of the ticks' times.
};

/// Returns which of a run's ticks a page of at most `rows_most` (> 0) shows, as numbers in order:
/// all of them if they fit. Else ticks in contact come first: all of them stay if they fit into
/// three quarters of the rows. Of what does not fit, equal stretches keep the ticks at which force,
/// asked force, depth, period and computing time are least and most; so do those of the whole run
/// at which any other column is least and most, and those before and after each touch. The rows
/// that are left go to where the path and the curves differ most from the row shown before. Every
/// row is a tick as it was, none an average. Real-time: never from the servo thread.
std::vector<std::size_t> rows_kept(const PageTicks& ticks, std::size_t rows_most);

/// Adds the ticks `kept` to a page under the names PREFIX + t (s from `begin_ns` on the loop's
/// clock), tick, tip, proxy, sent, asked, depth, period, work, speed, object, touching; SI units,
/// W. The period is the time since the tick before, kept or not. Real-time: never from the servo
/// thread.
void add_rows(PageBlock& block, const std::string& prefix, const PageTicks& ticks,
              std::span<const std::size_t> kept, std::int64_t begin_ns);

}  // namespace thimble::report
