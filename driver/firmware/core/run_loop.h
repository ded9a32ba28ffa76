#pragma once

#include "board.h"

namespace thimble {
namespace firmware {

/// The main loop of a board. Each pass takes the messages that have arrived. Once per period it
/// also measures the inputs and sends a report.
class RunLoop {
 public:
  /// Precondition: `board::start` was called.
  RunLoop() noexcept;

  /// Does one pass. Returns whether it was a tick.
  bool pass() noexcept;

  Controller& controller() noexcept { return controller_; }

 private:
  void describe() noexcept;

  // At most this number of messages is taken in a pass, so that a flood of them does not delay a
  // tick. [chosen: more than a host sends in a period]
  static constexpr int kMessagesMax = 4;

  Controller controller_;
  uint16_t report_every_, report_in_ = 1;
  uint32_t described_us_ = 0;
};

}  // namespace firmware
}  // namespace thimble
