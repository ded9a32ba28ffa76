#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "thimble/driver/export.h"

namespace thimble::driver::hfab {

// The text lines of the Haptikfabriken boards on USB serial (Teensy, 16c0:048x): the host sends
// "[mA,mA,mA]\n", the arm answers "[model,a,b,c,d,e,f,error]\n" and says nothing by itself [S
// forsslund/woodenhaptics firmware/woody_teensy_mini; forsslund/hfabapi hfab_protocol.h].
// Everything here is Real-time: safe.

/// Room for the longest line of either direction, in bytes: 8 numbers of 11 characters, 7
/// commas, two brackets, the newline.
inline constexpr std::size_t kLineCapacity = 98;

/// Which arm a board drives; it chooses the geometry [S].
enum class LineModel : std::int32_t { kPolhem = 1, kVintage = 2, kWoody = 3 };

// What the board says of the host's message in `ArmLine::error` [S]. Bits 1, 2 and 4: a gimbal
// sensor could not be read.
inline constexpr std::int32_t kErrorTrailing = 8;      ///< Characters after the closing bracket.
inline constexpr std::int32_t kErrorBufferFull = 128;  ///< No closing bracket in 127 characters.
inline constexpr std::int32_t kErrorNoStart = 256;  ///< A closing bracket without an opening one.
inline constexpr std::int32_t kErrorLength = 512;   ///< Not three numbers.
inline constexpr std::int32_t kErrorParse = 1024;   ///< Something else than numbers.
/// Every error after which the board repeats its last counts instead of reading its encoders.
inline constexpr std::int32_t kErrorStale =
    kErrorTrailing | kErrorBufferFull | kErrorNoStart | kErrorLength | kErrorParse;

/// What the arm answers.
struct ArmLine {
  std::int32_t model = 1;                ///< What the board calls its arm.
  std::array<std::int32_t, 6> counts{};  ///< Motor encoders a to c, gimbal encoders d to f.
  std::int32_t error = 0;                ///< Of the board; 0: none.

  friend bool operator==(const ArmLine&, const ArmLine&) = default;
};

/// What the host says. The board takes a current beyond its range as zero [S].
struct HostLine {
  std::array<std::int32_t, 3> current_mA{};  ///< Currents of the motors, mA.

  friend bool operator==(const HostLine&, const HostLine&) = default;
};

/// Decodes an answer. It must begin with '[', hold exactly eight decimal numbers that fit 32 bits
/// and end with ']', which newline, carriage return or zero bytes may follow; anything else is
/// empty.
THIMBLE_EXPORT std::optional<ArmLine> decode_arm_line(std::span<const std::byte> bytes) noexcept;

/// Encodes an answer (used by the simulated arm); returns its length.
THIMBLE_EXPORT std::size_t encode_arm_line(const ArmLine& line,
                                           std::span<std::byte, kLineCapacity> bytes) noexcept;

/// Decodes what the host said (used by the simulated arm); strict like `decode_arm_line`, with
/// three numbers.
THIMBLE_EXPORT std::optional<HostLine> decode_host_line(std::span<const std::byte> bytes) noexcept;

/// Encodes what the host says; returns its length.
THIMBLE_EXPORT std::size_t encode_host_line(const HostLine& line,
                                            std::span<std::byte, kLineCapacity> bytes) noexcept;

}  // namespace thimble::driver::hfab
