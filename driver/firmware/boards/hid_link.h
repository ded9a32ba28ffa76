#pragma once

#include <stdint.h>

namespace thimble {
namespace firmware {
namespace hid_link {

// A board of core/board.h with a USB controller: hid_link.cpp has its functions `config`,
// `tick_due`, `connected`, `receive`, `send` and `describe`. The board has the others.

/// What differs between the boards.
struct Board {
  const char* name;    ///< At most 6 characters.
  uint8_t serial[8];   ///< Serial number of the chip.
  uint16_t loop_hz;    ///< Rate of the loop.
  uint16_t report_hz;  ///< Rate of the reports: that at which the host asks for them.
};

/// Connects to the bus; the first tick is due at once. The clock of the board must run.
void start(const Board& board) noexcept;

}  // namespace hid_link
}  // namespace firmware
}  // namespace thimble
