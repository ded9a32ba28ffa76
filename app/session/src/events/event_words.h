#pragma once

#include <spdlog/common.h>

#include <cstdint>
#include <span>
#include <string>

#include "events/tick_event.h"
#include "thimble/driver/export.h"

namespace thimble::session {

/// Returns the log level of an event: info for normal events, warn for events that the user should
/// check, error for a fault; debug and trace for events of every touch.
spdlog::level::level_enum level_of(const TickEvent& event) noexcept;

/// Returns whether an event is printed on the console at once.
bool is_notice(const TickEvent& event) noexcept;

/// Returns the time of an event, as at the start of each line of a run.
THIMBLE_EXPORT std::string at_tick(std::uint64_t tick, std::int64_t time_ns);

/// Returns an event as a line of the log, with tick and time. `objects`: names of the scene's
/// objects. Real-time: never from the servo thread.
THIMBLE_EXPORT std::string words_of(const TickEvent& event, std::span<const std::string> objects);

}  // namespace thimble::session
