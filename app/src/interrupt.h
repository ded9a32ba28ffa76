#pragma once

#include <atomic>

namespace thimble::app {

/// Makes Ctrl-C (SIGINT) and SIGTERM set a flag that every loop looks at in each tick, so that the
/// program leaves by zero force. A second Ctrl-C ends the process at once; the arm's own watchdog
/// is then what stops the motors.
const std::atomic<bool>& catch_interrupts();

/// Sets that flag as a first Ctrl-C would. Real-time: safe.
void ask_to_stop() noexcept;

}  // namespace thimble::app
