#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace thimble::driver {

/// Reads the 16-bit word number `word` of a report, low byte first. Precondition: the report holds
/// it. Real-time: safe.
inline std::int16_t get_word(std::span<const std::byte> bytes, std::size_t word) noexcept {
  static_assert(std::endian::native == std::endian::little);
  std::int16_t value = 0;
  std::memcpy(&value, bytes.data() + 2 * word, sizeof(value));
  return value;
}

/// Writes the 16-bit word number `word` of a report, low byte first. Precondition: the report has
/// room for it. Real-time: safe.
inline void put_word(std::span<std::byte> bytes, std::size_t word, std::int16_t value) noexcept {
  static_assert(std::endian::native == std::endian::little);
  std::memcpy(bytes.data() + 2 * word, &value, sizeof(value));
}

}  // namespace thimble::driver
