#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "little_endian.h"

namespace thimble::driver::hfab {

// The 14-byte reports of the Haptikfabriken arms (Polhem v2, 16c0:0486), little endian. Source:
// their published firmware and host library (see app/guide/pages/driver.md, mark [S]). Boards built
// on the Teensy pad both to 64 bytes. Everything here is Real-time: safe.

inline constexpr std::size_t kReportSize = 14;
inline constexpr std::size_t kPaddedReportSize = 64;

/// A report from the arm: counters of three motor and three gimbal encoders, and a flag word.
struct InputReport {
  std::array<std::int16_t, 6> counts{};  ///< Encoders a to f.
  /// Bit 0: the calibration button was pressed and no preset has been received since. The other
  /// bits are unknown.
  std::int16_t info = 0;

  friend bool operator==(const InputReport&, const InputReport&) = default;
};

/// Command of an output report.
enum class Command : std::int16_t {
  kDrive = 0,  ///< Use the currents. (Every value but 1 means this; the host library sends 0 or 2.)
  kPreset = 1,  ///< Set counters a, b, c from the attributes and d, e, f from the current fields.
};

/// A report from the host: motor currents, or a preset for the counters.
struct OutputReport {
  std::array<std::int16_t, 3> current_mA{};  ///< Currents of the motors, mA.
  std::int16_t command = 0;                  ///< A Command.
  std::array<std::int16_t, 3> attributes{};  ///< Counter values for kPreset.

  friend bool operator==(const OutputReport&, const OutputReport&) = default;
};

/// Returns whether `size` is a possible length of a report. Real-time: safe.
constexpr bool is_report_size(std::size_t size) noexcept {
  return size == kReportSize || size == kPaddedReportSize;
}

// The functions below are inline so that values stay in registers. Written to memory word by word
// and read back as a whole, they would stall the processor.

/// Reads a report of the arm. Precondition: the bytes may be a report (is_report_size).
inline InputReport read_input(std::span<const std::byte> bytes) noexcept {
  return {.counts = {get_word(bytes, 0), get_word(bytes, 1), get_word(bytes, 2), get_word(bytes, 3),
                     get_word(bytes, 4), get_word(bytes, 5)},
          .info = get_word(bytes, 6)};
}
/// Reads a report of the host. Precondition: the bytes may be a report (is_report_size).
inline OutputReport read_output(std::span<const std::byte> bytes) noexcept {
  return {.current_mA = {get_word(bytes, 0), get_word(bytes, 1), get_word(bytes, 2)},
          .command = get_word(bytes, 3),
          .attributes = {get_word(bytes, 4), get_word(bytes, 5), get_word(bytes, 6)}};
}
/// Writes a report of the arm.
inline void write_input(const InputReport& report,
                        std::span<std::byte, kReportSize> bytes) noexcept {
  const auto& [a, b, c, d, e, f] = report.counts;
  put_four_words(bytes, 0, {a, b, c, d});
  put_word(bytes, 4, e);
  put_word(bytes, 5, f);
  put_word(bytes, 6, report.info);
}
/// Writes a report of the host.
inline void write_output(const OutputReport& report,
                         std::span<std::byte, kReportSize> bytes) noexcept {
  const auto& [a, b, c] = report.current_mA;
  put_four_words(bytes, 0, {a, b, c, report.command});
  for (std::size_t i = 0; i < 3; ++i) put_word(bytes, 4 + i, report.attributes[i]);
}

/// Checked versions of the functions above. Decoding is empty unless the input is 14 bytes, or 64
/// bytes, of which the first 14 are used.
inline std::optional<InputReport> decode_input(std::span<const std::byte> bytes) noexcept {
  if (!is_report_size(bytes.size())) return std::nullopt;
  return read_input(bytes);
}
inline std::optional<OutputReport> decode_output(std::span<const std::byte> bytes) noexcept {
  if (!is_report_size(bytes.size())) return std::nullopt;
  return read_output(bytes);
}
inline std::array<std::byte, kReportSize> encode_input(const InputReport& report) noexcept {
  std::array<std::byte, kReportSize> bytes;
  write_input(report, bytes);
  return bytes;
}
inline std::array<std::byte, kReportSize> encode_output(const OutputReport& report) noexcept {
  std::array<std::byte, kReportSize> bytes;
  write_output(report, bytes);
  return bytes;
}

/// Pads a report of either direction with zeros, as boards built on the Teensy send and accept it.
inline std::array<std::byte, kPaddedReportSize> pad(
    const std::array<std::byte, kReportSize>& report) noexcept {
  std::array<std::byte, kPaddedReportSize> padded{};
  std::copy(report.begin(), report.end(), padded.begin());
  return padded;
}

}  // namespace thimble::driver::hfab
