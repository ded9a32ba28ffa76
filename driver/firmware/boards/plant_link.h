#pragma once

#include <stddef.h>
#include <stdint.h>

namespace thimble {
namespace firmware {

// A board whose motors and encoders are at the other end of a second byte stream, for emulated
// processors. The plant determines the time, so that runs are repeatable. Both streams have the
// frames of cobs.h and the CRC of the wire.
//
// From the plant:
//   0x42 configuration: the self-description of the arm with this type. The board starts with it.
//   0x43 health, 18 bytes: u8 type, u8 version, i16 gimbal x 3, u16 supply_mV, i16 temperature, u8
//        encoder error, u8 buttons, u8 1: the board stops feeding its hardware watchdog, u8 spare,
//        u16 CRC. It holds until the next one.
//   0x40 sensors, 22 bytes: u8 type, u8 version, u8 1: tick, 0: only the time passes, u8 spare,
//        u32 time_us, i32 counts x 3, u16 CRC.
// To the plant, after each sensors frame and each pass with a message of the host:
//   0x41 motors, 30 bytes: u8 type, u8 version, u8 motors on, u8 lamp lit, f32 amperes x 3, u32
//        duration of the pass in units of the board's clock, u32 that clock in Hz, u32 time of the
//        last message that fed the watchdog, us, u16 CRC.

constexpr uint8_t kSensors = 0x40, kMotors = 0x41, kConfiguration = 0x42, kHealth = 0x43;
constexpr size_t kSensorsSize = 22, kMotorsSize = 30, kHealthSize = 18;

namespace plant_link {

// The functions that such a board implements. Port 0 leads to the host, port 1 to the plant.

/// Starts ports and clock.
void start() noexcept;
/// Takes a byte of a port; returns false if there is none.
bool get(int port, uint8_t& byte) noexcept;
/// Sends a byte; waits until the port takes it.
void put(int port, uint8_t byte) noexcept;
/// Waits until a port has a byte; may return earlier. The time of the hardware watchdog does not
/// pass meanwhile.
void wait() noexcept;
/// Returns a clock that counts up, and its rate.
uint32_t clock() noexcept;
uint32_t clock_hz() noexcept;
/// Restarts the time of the hardware watchdog.
void feed() noexcept;
/// Returns whether the hardware watchdog has restarted the board.
bool restarted() noexcept;

}  // namespace plant_link
}  // namespace firmware
}  // namespace thimble
