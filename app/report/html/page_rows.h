#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "report/html/page_block.h"
#include "thimble/driver/tick_record.h"

namespace thimble::report {

/// Ticks of one arm, each with the time since the previous tick.
struct PageTicks {
  PageTicks() = default;
  /// Takes consecutive ticks.
  PageTicks(std::span<const driver::TickRecord> all) : ticks(all) {}     // NOLINT(*-explicit-*)
  PageTicks(const std::vector<driver::TickRecord>& all) : ticks(all) {}  // NOLINT(*-explicit-*)
  /// Takes ticks with gaps between them, with one period (ns) each.
  PageTicks(std::span<const driver::TickRecord> some, std::span<const std::int64_t> periods)
      : ticks(some), periods_ns(periods) {}

  /// Returns the time since the previous tick for tick `i`, ns; for the first tick, that of the
  /// second. Without `periods_ns` it is the mean if ticks before it were omitted.
  std::int64_t period_ns(std::size_t i) const noexcept;

  std::span<const driver::TickRecord> ticks;
  std::span<const std::int64_t> periods_ns;  ///< Empty: computed from the ticks' times.
};

/// Returns the numbers of the ticks that a page of at most `max_rows` (> 0) rows shows, in order;
/// all ticks if they fit. Otherwise ticks in contact have priority: all are kept if they fit into
/// three quarters of the rows. The other ticks are divided into equal stretches, which keep the
/// ticks with minimum and maximum force, requested force, depth, period and computing time. Also
/// kept are the ticks of the whole run with the minimum and maximum of any other column, and those
/// before and after each touch. The remaining rows go to where the path and the curves differ most
/// from the row shown before. Every row is an original tick, not an average. Real-time: never from
/// the servo thread.
std::vector<std::size_t> rows_kept(const PageTicks& ticks, std::size_t max_rows);

/// Adds the ticks `kept` to a page; SI units, W. The arrays are PREFIX + t (s from `begin_ns` on
/// the loop's clock), tick, tip, proxy, sent, asked, depth, period, work, speed, object, touching.
/// The period is the time since the previous tick, kept or not. Real-time: never from the servo
/// thread.
void add_rows(PageBlock& block, const std::string& prefix, const PageTicks& ticks,
              std::span<const std::size_t> kept, std::int64_t begin_ns);

}  // namespace thimble::report
