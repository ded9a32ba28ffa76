#pragma once

#include <stddef.h>
#include <stdint.h>

#include "controller.h"

namespace thimble {
namespace firmware {
namespace board {

// The functions that each board implements (driver/firmware/boards). None of them waits, except
// `start`.

/// Starts clocks, pins, counters and the link. Afterwards the motors are off.
void start() noexcept;

/// Returns the data of the arm, with the chip's serial number and the name of the board.
ArmConfig config() noexcept;

/// Returns whether the hardware watchdog has restarted the board. Valid after `start`.
bool restarted() noexcept;

/// Returns the time since the start, us; wraps.
uint32_t now_us() noexcept;

/// Returns true once per period of the loop, at its beginning.
bool tick_due() noexcept;

/// Measures the inputs.
void sample(Inputs& inputs) noexcept;

/// Applies the outputs. Called after each change; must switch off at once if the motors are off.
void apply(const Outputs& outputs) noexcept;

/// Switches the lamp.
void lamp(bool lit) noexcept;

/// Restarts the time of the hardware watchdog. Without this call, the chip restarts within 100 ms,
/// which switches the motors off.
void feed_watchdog() noexcept;

/// Returns whether the host is connected: the bus is configured and not suspended. A board on a
/// UART always returns true.
bool connected() noexcept;

/// Copies the next message of the host, without its framing, into `message` (kHidReportSize bytes).
/// Returns its size, or 0 if there is none.
size_t receive(uint8_t* message) noexcept;

/// Sends a state. Drops it if the link is busy or closed.
void send(const uint8_t* state) noexcept;

/// Sends the self-description. A HID board stores it for requests of the host instead.
void describe(const uint8_t* description) noexcept;

}  // namespace board
}  // namespace firmware
}  // namespace thimble
