#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace thimble::driver::hfab {

// The 14-byte reports of the Haptikfabriken arms (Polhem v2, 16c0:0486), little endian, as read in
// their published firmware and host library (see driver/README.md, mark [S]). Boards built on the
// Teensy pad both to 64 bytes. Everything here is Real-time: safe.

inline constexpr std::size_t kReportSize = 14;
inline constexpr std::size_t kPaddedReportSize = 64;

/// What the arm sends: counters of three motor and three gimbal encoders, and a flag word.
struct InputReport {
  std::array<std::int16_t, 6> counts{};  ///< Encoders a to f.
  /// Bit 0: the calibration button was pressed and no preset came since. The other bits are
  /// unknown.
  std::int16_t info = 0;

  friend bool operator==(const InputReport&, const InputReport&) = default;
};

/// What an output report asks of the firmware.
enum class Command : std::int16_t {
  kDrive = 0,  ///< Use the currents. (Every value but 1 means this; the host library sends 0 or 2.)
  kPreset = 1,  ///< Set counters a, b, c from the attributes and d, e, f from the current fields.
};

/// What the arm takes: motor currents, or a preset for its counters.
struct OutputReport {
  std::array<std::int16_t, 3> current_mA{};  ///< Currents of the motors, mA.
  std::int16_t command = 0;                  ///< A Command.
  std::array<std::int16_t, 3> attributes{};  ///< What kPreset sets counters by.

  friend bool operator==(const OutputReport&, const OutputReport&) = default;
};

/// Decodes what the arm sent; empty unless it is 14 bytes, or 64 of which the first 14 count.
std::optional<InputReport> decode_input(std::span<const std::byte> bytes) noexcept;

/// Encodes what the arm sends (used by the simulated arm).
std::array<std::byte, kReportSize> encode_input(const InputReport& report) noexcept;

/// Decodes what the host sent (used by the simulated arm); lengths as in `decode_input`.
std::optional<OutputReport> decode_output(std::span<const std::byte> bytes) noexcept;

/// Encodes what the host sends.
std::array<std::byte, kReportSize> encode_output(const OutputReport& report) noexcept;

/// Pads a report of either direction with zeros, as boards built on the Teensy send and take it.
std::array<std::byte, kPaddedReportSize> pad(
    const std::array<std::byte, kReportSize>& report) noexcept;

}  // namespace thimble::driver::hfab
