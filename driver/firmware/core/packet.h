#pragma once

#include <stddef.h>
#include <stdint.h>

#include "arm_config.h"

namespace thimble {
namespace firmware {

// Messages of the wire, version 1. driver/firmware/README.md is its definition.

constexpr uint8_t kWireVersion = 1;
constexpr size_t kStateSize = 48;         ///< Bytes of a state.
constexpr size_t kDescriptionSize = 64;   ///< Bytes of a self-description.
constexpr size_t kDriveSize = 18;         ///< Bytes of a drive message, the longest to the board.
constexpr size_t kHidReportSize = 64;     ///< Bytes of a HID report of either direction.
constexpr int16_t kNoSensor = INT16_MIN;  ///< Temperature without a sensor.

/// Type of a message.
enum MessageType : uint8_t {
  kState = 0x01,
  kDescription = 0x02,
  kDrive = 0x10,
  kStop = 0x11,
  kClear = 0x12,
  kSetCounters = 0x13,
  kBlink = 0x14,
  kDescribe = 0x15,
};

/// Bits of the flags of a state.
enum Flag : uint16_t {
  kWatchdog = 1 << 0,
  kOverSpeed = 1 << 1,
  kOverTemperature = 1 << 2,
  kBrownOut = 1 << 3,
  kEncoder = 1 << 4,
  kBadCommand = 1 << 5,
  kLateLoop = 1 << 6,
  kLinkLost = 1 << 7,
  kRestarted = 1 << 8,  ///< A note, no fault.
};

/// Stage of the board.
enum class Stage : uint8_t { kOff = 0, kDriving = 1, kFault = 2 };

/// Content of a state.
struct State {
  uint16_t number = 0;
  uint32_t time_us = 0;
  int32_t counts[kMotorsMax] = {};
  uint16_t flags = 0;
  Stage stage = Stage::kOff;
  uint8_t buttons = 0;
  int16_t current_mA[kMotorsMax] = {};
  int16_t temperature_dC = kNoSensor;
  uint16_t supply_mV = 0;
  uint16_t echo = 0;
  int16_t gimbal[3] = {};
  uint16_t refused = 0;
  uint16_t loop_us = 0;
};

/// A message of the host.
struct Command {
  uint8_t type = 0;
  uint16_t number = 0;
  float amperes[kMotorsMax] = {};     ///< Of a drive message; may be any numbers, also NaN.
  int32_t counters[kMotorsMax] = {};  ///< Of a message that sets the counters.
  uint16_t duration_ms = 0;           ///< Of a blink message.
};

/// Encodes a state into kStateSize bytes.
void encode_state(const State& state, uint8_t* bytes) noexcept;

/// Encodes the self-description of an arm into kDescriptionSize bytes.
void encode_description(const ArmConfig& config, uint16_t flags, uint8_t* bytes) noexcept;

/// Decodes the content of a self-description, without the check of its CRC. A rate or number that
/// would be unusable keeps its default.
void decode_description(const uint8_t* bytes, ArmConfig& config) noexcept;

/// Decodes a message of the host: its exact length, or a HID report that begins with it. Returns
/// false, and leaves `command` unchanged, if version, type, length or CRC is wrong. Total: accepts
/// any bytes.
bool decode_command(const uint8_t* bytes, size_t size, Command& command) noexcept;

}  // namespace firmware
}  // namespace thimble
