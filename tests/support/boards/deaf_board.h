#pragma once

#include <string_view>

namespace thimble::support {

/// Returns whether a fault of a board's reports ("stall in") keeps the zero force from it. A HID
/// board that only answers does not read messages until the host takes its report. The zero does
/// not reach it, and its last force remains until its own watchdog acts.
constexpr bool is_deaf(bool hid, bool answers_only, std::string_view fault) {
  return hid && answers_only && (fault == "stall in" || fault == "silence in");
}

}  // namespace thimble::support
