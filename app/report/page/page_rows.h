#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "report/page/page_block.h"
#include "thimble/driver/tick_record.h"

namespace thimble::app {

/// Returns which of a run's ticks a page of at most `rows_most` (> 0) shows, as numbers in order:
/// all of them if they fit. Else the run is cut into equal stretches of ticks, and of each those
/// stay at which force, asked force, depth, period and computing time are least and most, so that
/// a plot of the rest has the same outline. Every row is a tick as it was, none an average.
/// Real-time: never from the servo thread.
std::vector<std::size_t> rows_kept(std::span<const driver::TickRecord> ticks,
                                   std::size_t rows_most);

/// Adds the ticks `kept` to a page under the names PREFIX + t (s from `begin_ns` on the loop's
/// clock), tick, tip, proxy, sent, asked, depth, period, work, speed, object, touching; SI units,
/// W. The period is the time since the tick before, kept or not. Real-time: never from the servo
/// thread.
void add_rows(PageBlock& block, const std::string& prefix,
              std::span<const driver::TickRecord> ticks, std::span<const std::size_t> kept,
              std::int64_t begin_ns);

}  // namespace thimble::app
