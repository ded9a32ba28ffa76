#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace thimble::device_sim::usb {

/// The eight bytes that begin every control transfer [USB 2.0, 9.3].
struct SetupPacket {
  std::uint8_t request_type = 0;  ///< Bit 7: towards the host; bits 5-6: kind; bits 0-4: recipient.
  std::uint8_t request = 0;       ///< Number of the request.
  std::uint16_t value = 0;        ///< Argument of the request.
  std::uint16_t index = 0;        ///< Interface or endpoint of the request.
  std::uint16_t length = 0;       ///< Bytes of the data stage.

  friend bool operator==(const SetupPacket&, const SetupPacket&) = default;

  /// Returns whether the data stage goes to the host. Real-time: safe.
  bool to_host() const noexcept { return (request_type & 0x80U) != 0; }
};

/// Recipients of a control request (bits 0-4 of `request_type`).
inline constexpr std::uint8_t kRecipientDevice = 0;
inline constexpr std::uint8_t kRecipientInterface = 1;
inline constexpr std::uint8_t kRecipientEndpoint = 2;

/// Kinds of a control request (bits 5-6 of `request_type`).
inline constexpr std::uint8_t kKindMask = 0x60;
inline constexpr std::uint8_t kKindStandard = 0x00;
inline constexpr std::uint8_t kKindClass = 0x20;
inline constexpr std::uint8_t kKindVendor = 0x40;

/// Reads a set-up packet; any eight bytes are valid. Real-time: safe.
inline SetupPacket decode_setup(std::span<const std::byte, 8> bytes) noexcept {
  const auto at = [&](std::size_t i) { return std::to_integer<unsigned>(bytes[i]); };
  return {.request_type = static_cast<std::uint8_t>(at(0)),
          .request = static_cast<std::uint8_t>(at(1)),
          .value = static_cast<std::uint16_t>(at(2) | (at(3) << 8)),
          .index = static_cast<std::uint16_t>(at(4) | (at(5) << 8)),
          .length = static_cast<std::uint16_t>(at(6) | (at(7) << 8))};
}

}  // namespace thimble::device_sim::usb
