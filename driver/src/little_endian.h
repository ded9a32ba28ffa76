#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace thimble::driver {

static_assert(std::endian::native == std::endian::little, "Words are taken as they lie.");

/// Reads the 16-bit word number `word` of a report, low byte first. Precondition: the report holds
/// it. Real-time: safe.
inline std::int16_t get_word(std::span<const std::byte> bytes, std::size_t word) noexcept {
  std::int16_t value = 0;
  std::memcpy(&value, bytes.data() + 2 * word, sizeof(value));
  return value;
}

/// Writes the 16-bit word number `word` of a report, low byte first. Precondition: the report has
/// room for it. Real-time: safe.
inline void put_word(std::span<std::byte> bytes, std::size_t word, std::int16_t value) noexcept {
  std::memcpy(bytes.data() + 2 * word, &value, sizeof(value));
}

/// Writes four words from word number `word` on, as one store of 64 bits: a later load of several
/// of them does not wait for each store. Precondition: as put_word. Real-time: safe.
inline void put_four_words(std::span<std::byte> bytes, std::size_t word,
                           const std::array<std::int16_t, 4>& values) noexcept {
  std::uint64_t all = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    all |= std::uint64_t{static_cast<std::uint16_t>(values[i])} << (16 * i);
  }
  std::memcpy(bytes.data() + 2 * word, &all, sizeof(all));
}

}  // namespace thimble::driver
