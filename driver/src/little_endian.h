#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace thimble::driver {

/// Reads the 16-bit word number `word` of a report, low byte first. Precondition: the report holds
/// it. Real-time: safe.
inline std::int16_t get_word(std::span<const std::byte> bytes, std::size_t word) noexcept {
  const auto low = std::to_integer<unsigned>(bytes[2 * word]);
  const auto high = std::to_integer<unsigned>(bytes[2 * word + 1]);
  return static_cast<std::int16_t>(static_cast<std::uint16_t>(low | (high << 8)));
}

/// Writes the 16-bit word number `word` of a report, low byte first. Precondition: the report has
/// room for it. Real-time: safe.
inline void put_word(std::span<std::byte> bytes, std::size_t word, std::int16_t value) noexcept {
  const auto bits = static_cast<std::uint16_t>(value);
  bytes[2 * word] = static_cast<std::byte>(bits & 0xff);
  bytes[2 * word + 1] = static_cast<std::byte>(bits >> 8);
}

}  // namespace thimble::driver
