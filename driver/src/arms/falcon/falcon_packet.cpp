#include "arms/falcon/falcon_packet.h"

namespace thimble::driver::falcon {
namespace {

constexpr unsigned kZero = 'A';
constexpr std::size_t kFlags = 13;
constexpr std::size_t kUnknown = 14;
constexpr std::size_t kLast = kPacketSize - 1;

using Packet = std::array<std::byte, kPacketSize>;

struct Parts {
  std::array<std::int16_t, 3> numbers{};
  std::uint8_t flags = 0;
  std::uint8_t unknown_14 = 0;
};

std::optional<Parts> decode(std::span<const std::byte> bytes) noexcept {
  if (bytes.size() != kPacketSize) return std::nullopt;
  if (bytes[0] != std::byte{'<'} || bytes[kLast] != std::byte{'>'}) return std::nullopt;
  Parts parts;
  for (std::size_t i = 0; i < 3; ++i) {
    unsigned value = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      // Below 'A' the difference wraps around and is far above 15.
      const unsigned nibble = std::to_integer<unsigned>(bytes[1 + 4 * i + k]) - kZero;
      if (nibble > 15) return std::nullopt;
      value |= nibble << (4 * k);
    }
    parts.numbers[i] = static_cast<std::int16_t>(static_cast<std::uint16_t>(value));
  }
  parts.flags = static_cast<std::uint8_t>(std::to_integer<unsigned>(bytes[kFlags]) - kZero);
  parts.unknown_14 = static_cast<std::uint8_t>(std::to_integer<unsigned>(bytes[kUnknown]) - kZero);
  return parts;
}

Packet encode(const Parts& parts) noexcept {
  Packet bytes{};
  bytes[0] = std::byte{'<'};
  for (std::size_t i = 0; i < 3; ++i) {
    const unsigned value = static_cast<std::uint16_t>(parts.numbers[i]);
    for (std::size_t k = 0; k < 4; ++k) {
      bytes[1 + 4 * i + k] = static_cast<std::byte>(kZero + ((value >> (4 * k)) & 15));
    }
  }
  bytes[kFlags] = static_cast<std::byte>(kZero + parts.flags);
  bytes[kUnknown] = static_cast<std::byte>(kZero + parts.unknown_14);
  bytes[kLast] = std::byte{'>'};
  return bytes;
}

}  // namespace

std::optional<ArmPacket> decode_arm_packet(std::span<const std::byte> bytes) noexcept {
  const auto parts = decode(bytes);
  // Bit 7 of the flags has no known meaning, so a packet with it is damaged.
  if (!parts || parts->flags > 0x7f) return std::nullopt;
  return ArmPacket{.counts = parts->numbers,
                   .buttons = static_cast<std::uint8_t>(parts->flags & 0x0f),
                   .homed = static_cast<std::uint8_t>(parts->flags >> 4),
                   .unknown_14 = parts->unknown_14};
}

std::array<std::byte, kPacketSize> encode_arm_packet(const ArmPacket& packet) noexcept {
  const unsigned flags = (packet.buttons & 0x0fU) | ((packet.homed & 0x07U) << 4);
  return encode({.numbers = packet.counts,
                 .flags = static_cast<std::uint8_t>(flags),
                 .unknown_14 = packet.unknown_14});
}

std::optional<HostPacket> decode_host_packet(std::span<const std::byte> bytes) noexcept {
  const auto parts = decode(bytes);
  if (!parts) return std::nullopt;
  return HostPacket{
      .motors = parts->numbers, .lights = parts->flags, .unknown_14 = parts->unknown_14};
}

std::array<std::byte, kPacketSize> encode_host_packet(const HostPacket& packet) noexcept {
  return encode(
      {.numbers = packet.motors, .flags = packet.lights, .unknown_14 = packet.unknown_14});
}

}  // namespace thimble::driver::falcon
