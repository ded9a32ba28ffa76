#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "thimble/driver/export.h"
#include "thimble/driver/transport.h"

namespace thimble::driver::falcon {

// The 16-byte packets of the Novint Falcon's firmware [S libnifalcon FalconFirmwareNovintSDK.h and
// .cpp]:
//
//   byte     0    1..4   5..8   9..12   13                  14        15
//   to arm  '<'   motor a, b, c         lights and homing   unknown   '>'
//   to host '<'   encoder a, b, c       buttons and homed   unknown   '>'
//
// A number is four nibbles, the lowest first, each sent as 'A' + nibble. Bytes 13 and 14 are 'A' +
// value. The arm answers each packet with one packet and sends nothing unasked. Everything here is
// Real-time: safe.

inline constexpr std::size_t kPacketSize = 16;

// Byte 13 to the arm. The sources contradict each other. The code of libnifalcon sets bit 0 for
// homing; its documentation names bit 4. One of its headers has red, green, blue as 2, 4, 8, a
// later one green, blue, red [S, both]. This file follows the code, because users run it.
inline constexpr std::uint8_t kHomingMode = 0x01;
inline constexpr std::uint8_t kGreenLight = 0x02;
inline constexpr std::uint8_t kBlueLight = 0x04;
inline constexpr std::uint8_t kRedLight = 0x08;

/// Value of `ArmPacket::homed` if all three legs are homed.
inline constexpr std::uint8_t kAllHomed = 0x07;

/// Framing of packets in the byte stream.
inline constexpr Framing kPacketFraming{
    .begin = std::byte{'<'}, .end = std::byte{'>'}, .size_max = kPacketSize};

/// A packet from the host.
struct HostPacket {
  std::array<std::int16_t, 3> motors{};  ///< Legs a, b, c; about 10,000 per N m [S libnifalcon].
  std::uint8_t lights = 0;               ///< kHomingMode and the lights.
  std::uint8_t unknown_14 = 0;           ///< Meaning unknown.

  friend bool operator==(const HostPacket&, const HostPacket&) = default;
};

/// A packet from the arm.
struct ArmPacket {
  std::array<std::int16_t, 3> counts{};  ///< Encoders of legs a, b, c.
  std::uint8_t buttons = 0;              ///< Four bits: right, forward, centre, left [S].
  std::uint8_t homed = 0;                ///< Three bits: leg a, b, c is homed.
  std::uint8_t unknown_14 = 0;           ///< Meaning unknown.

  friend bool operator==(const ArmPacket&, const ArmPacket&) = default;
};

/// Decodes an answer; empty unless it is 16 bytes with the brackets in place and each digit one of
/// 'A' to 'P'.
std::optional<ArmPacket> decode_arm_packet(std::span<const std::byte> bytes) noexcept;

/// Encodes an answer (used by the simulated arm).
THIMBLE_EXPORT std::array<std::byte, kPacketSize> encode_arm_packet(
    const ArmPacket& packet) noexcept;

/// Decodes a packet of the host (used by the simulated arm), with the same checks.
THIMBLE_EXPORT std::optional<HostPacket> decode_host_packet(
    std::span<const std::byte> bytes) noexcept;

/// Encodes a packet of the host.
std::array<std::byte, kPacketSize> encode_host_packet(const HostPacket& packet) noexcept;

}  // namespace thimble::driver::falcon
