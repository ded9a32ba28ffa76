#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "thimble/driver/export.h"

namespace thimble::driver::hfab {

// The text lines of the Haptikfabriken boards on USB serial (Teensy, 16c0:048x). The host sends
// "[mA,mA,mA]
// ". The arm answers "[model,a,b,c,d,e,f,error]
// " and sends nothing unasked [S forsslund/woodenhaptics firmware/woody_teensy_mini;
// forsslund/hfabapi hfab_protocol.h]. Everything here is Real-time: safe.

/// Length of the longest line of either direction, bytes: 8 numbers of 11 characters, 7 commas, two
/// brackets, the newline.
inline constexpr std::size_t kLineCapacity = 98;

/// The arm that a board drives; it determines the geometry [S].
enum class LineModel : std::int32_t { kPolhem = 1, kVintage = 2, kWoody = 3 };

// Bits of `ArmLine::error`: faults that the board found in the host's message [S]. Bits 1, 2 and 4:
// a gimbal sensor could not be read.
inline constexpr std::int32_t kErrorTrailing = 8;      ///< Characters after the closing bracket.
inline constexpr std::int32_t kErrorBufferFull = 128;  ///< No closing bracket in 127 characters.
inline constexpr std::int32_t kErrorNoStart = 256;  ///< A closing bracket without an opening one.
inline constexpr std::int32_t kErrorLength = 512;   ///< Not three numbers.
inline constexpr std::int32_t kErrorParse = 1024;   ///< Not numbers.
/// Errors after which the board repeats its last counts instead of reading its encoders.
inline constexpr std::int32_t kErrorStale =
    kErrorTrailing | kErrorBufferFull | kErrorNoStart | kErrorLength | kErrorParse;

/// A line from the arm.
struct ArmLine {
  std::int32_t model = 1;                ///< Model number of the arm, see LineModel.
  std::array<std::int32_t, 6> counts{};  ///< Motor encoders a to c, gimbal encoders d to f.
  std::int32_t error = 0;                ///< Error bits of the board; 0: none.

  friend bool operator==(const ArmLine&, const ArmLine&) = default;
};

/// A line from the host. The board treats a current beyond its range as zero [S].
struct HostLine {
  std::array<std::int32_t, 3> current_mA{};  ///< Currents of the motors, mA.

  friend bool operator==(const HostLine&, const HostLine&) = default;
};

/// Decodes an answer. It must begin with '[', hold exactly eight decimal numbers that fit 32 bits,
/// and end with ']'. Newline, carriage return or zero bytes may follow. Otherwise the result is
/// empty.
THIMBLE_EXPORT std::optional<ArmLine> decode_arm_line(std::span<const std::byte> bytes) noexcept;

/// Encodes an answer (used by the simulated arm); returns its length.
THIMBLE_EXPORT std::size_t encode_arm_line(const ArmLine& line,
                                           std::span<std::byte, kLineCapacity> bytes) noexcept;

/// Decodes a line of the host (used by the simulated arm); strict like `decode_arm_line`, with
/// three numbers.
THIMBLE_EXPORT std::optional<HostLine> decode_host_line(std::span<const std::byte> bytes) noexcept;

/// Encodes a line of the host; returns its length.
THIMBLE_EXPORT std::size_t encode_host_line(const HostLine& line,
                                            std::span<std::byte, kLineCapacity> bytes) noexcept;

}  // namespace thimble::driver::hfab
