#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include "thimble/driver/arm.h"

namespace thimble::firmware_test {

/// The host's side of the wire of driver/firmware/README.md, on HID. It shares no code with the
/// firmware, so that a mistake in either is found.
struct HostWire {
  static constexpr std::size_t kReport = 64, kState = 48;

  static std::uint32_t field(std::span<const std::byte> bytes, std::size_t at, std::size_t size) {
    std::uint32_t value = 0;
    for (std::size_t i = size; i-- > 0;) {
      value = value << 8 | std::to_integer<std::uint32_t>(bytes[at + i]);
    }
    return value;
  }

  static std::uint16_t crc(std::span<const std::byte> bytes) noexcept {
    std::uint32_t crc = 0xffff;
    for (const std::byte byte : bytes) {
      for (int bit = 7; bit >= 0; --bit) {
        const bool carry = (crc >> 15 & 1) != (std::to_integer<std::uint32_t>(byte) >> bit & 1);
        crc = (crc << 1 & 0xffff) ^ (carry ? 0x1021 : 0);
      }
    }
    return static_cast<std::uint16_t>(crc);
  }

  static bool decode(std::span<const std::byte> bytes, driver::ArmReading& reading) noexcept {
    if (bytes.size() != kReport || field(bytes, 0, 2) != 0x0101) return false;
    if (crc(bytes.first(kState - 2)) != field(bytes, kState - 2, 2)) return false;
    for (std::size_t i = 0; i < 3; ++i) {
      reading.counts[i] = static_cast<std::int32_t>(field(bytes, 8 + 4 * i, 4));
      reading.auxiliary[i] = static_cast<std::int16_t>(field(bytes, 36 + 2 * i, 2));
    }
    reading.buttons = static_cast<std::uint16_t>(field(bytes, 23, 1));
    reading.number = static_cast<std::uint16_t>(field(bytes, 2, 2));
    return true;
  }

  static std::size_t encode(const std::array<std::int16_t, 3>& mA,
                            std::span<std::byte, driver::kReportCapacity> bytes) noexcept {
    std::fill_n(bytes.begin(), kReport, std::byte{0});
    bytes[0] = std::byte{0x10};
    bytes[1] = std::byte{1};
    const auto put = [&](std::size_t at, std::uint32_t value, std::size_t size) {
      for (std::size_t i = 0; i < size; ++i, value >>= 8) {
        bytes[at + i] = static_cast<std::byte>(value & 0xff);
      }
    };
    for (std::size_t i = 0; i < 3; ++i) {
      put(4 + 4 * i, std::bit_cast<std::uint32_t>(1e-3f * static_cast<float>(mA[i])), 4);
    }
    put(16, crc(bytes.first(16)), 2);
    return kReport;
  }
};

}  // namespace thimble::firmware_test
