#pragma once

#include <atomic>

namespace thimble::app {

/// Makes Ctrl-C (SIGINT), SIGTERM and a closed terminal (SIGHUP; not under nohup) set a flag that
/// every loop looks at in each tick, so that the program leaves by zero force. A second Ctrl-C ends
/// the process at once; the arm's own watchdog is then what stops the motors.
const std::atomic<bool>& catch_interrupts();

/// Lets a reader of our output that is gone, and a file that may not grow, be errors of the write
/// that meets them: a process that dies of them leaves the arm to its own watchdog. Real-time:
/// never from the servo thread.
void outlive_trouble_with_files();

/// Sets that flag as a first Ctrl-C would. Real-time: safe.
void ask_to_stop() noexcept;

}  // namespace thimble::app
