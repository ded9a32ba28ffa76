#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "thimble/driver/export.h"

namespace thimble::driver::woody {

// The 8-byte HID reports of the WoodenHaptics board (mbed LPC1768, 1234:0006), little endian [S
// WoodenHaptics/woody-experimental, mbed-code/WoodenHapticsHID/main.cpp]. The board accepts a
// message only if it is exactly 8 bytes long. Everything here is Real-time: safe.

inline constexpr std::size_t kReportSize = 8;

/// A report from the arm.
struct InputReport {
  std::array<std::int16_t, 3> counts{};  ///< Encoders a to c.
  std::uint16_t counter = 0;             ///< Incremented with each report of the board [S].

  friend bool operator==(const InputReport&, const InputReport&) = default;
};

/// A report from the host. The board clamps a current beyond 3 A; it does not refuse it [S].
struct OutputReport {
  std::array<std::int16_t, 3> current_mA{};  ///< Currents of the motors, mA.
  std::uint16_t unknown_debug = 0;  ///< Named "debug" in the firmware, which never reads it [S].

  friend bool operator==(const OutputReport&, const OutputReport&) = default;
};

/// Decodes a report of the arm; empty unless it is 8 bytes long.
std::optional<InputReport> decode_input(std::span<const std::byte> bytes) noexcept;

/// Encodes a report of the arm (used by the simulated arm).
THIMBLE_EXPORT std::array<std::byte, kReportSize> encode_input(const InputReport& report) noexcept;

/// Decodes a report of the host (used by the simulated arm); empty unless it is 8 bytes long.
THIMBLE_EXPORT std::optional<OutputReport> decode_output(std::span<const std::byte> bytes) noexcept;

/// Encodes a report of the host.
std::array<std::byte, kReportSize> encode_output(const OutputReport& report) noexcept;

}  // namespace thimble::driver::woody
