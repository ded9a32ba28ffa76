#pragma once

#include <stdint.h>

#include "hid_device.h"

namespace thimble {
namespace firmware {
namespace usb_port {

// The USB controller of a chip. None of the functions waits.

/// Starts the controller and connects to the bus.
void start(HidDevice& device) noexcept;

/// Handles the events since the last call: passes requests, resets and suspensions of the bus to
/// the device. Call it in each pass of the main loop.
void poll(HidDevice& device) noexcept;

/// Copies a received report (HidDevice::kPacketSize bytes). Returns false if there is none.
bool receive(uint8_t* report) noexcept;

/// Sends a report of up to HidDevice::kPacketSize bytes; the rest is zero. Replaces one that the
/// host has not yet fetched only if the controller can; otherwise it is dropped.
void send(const uint8_t* report, uint16_t size) noexcept;

}  // namespace usb_port
}  // namespace firmware
}  // namespace thimble
