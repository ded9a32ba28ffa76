#pragma once

#include <spdlog/common.h>

#include <cstdint>
#include <span>
#include <string>

#include "events/tick_event.h"
#include "thimble/driver/export.h"

namespace thimble::session {

/// Returns how much an event matters: info for what happens, warn for what the user should look
/// at, error for a fault; debug and trace for what any touch does.
spdlog::level::level_enum level_of(const TickEvent& event) noexcept;

/// Returns whether the user hears of an event at once, on the console.
bool is_notice(const TickEvent& event) noexcept;

/// Returns when something happened, as each line of a run begins.
THIMBLE_EXPORT std::string at_tick(std::uint64_t tick, std::int64_t time_ns);

/// Returns an event as a line of the log, with its tick and its time. `objects` are the names of
/// the scene's objects. Real-time: never from the servo thread.
THIMBLE_EXPORT std::string words_of(const TickEvent& event, std::span<const std::string> objects);

}  // namespace thimble::session
