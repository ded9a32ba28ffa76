#pragma once

#include <stddef.h>
#include <stdint.h>

namespace thimble {
namespace firmware {

/// Computes CRC-16/CCITT-FALSE: polynomial 0x1021, initial value 0xffff, not reflected. Without a
/// table, because flash is small.
inline uint16_t crc16(const uint8_t* bytes, size_t size) noexcept {
  // In bytes, because processors of 8 bits shift words slowly.
  uint8_t high = 0xff, low = 0xff;
  for (size_t i = 0; i < size; ++i) {
    uint8_t x = static_cast<uint8_t>(high ^ bytes[i]);
    x = static_cast<uint8_t>(x ^ (x >> 4));
    const uint8_t upper = static_cast<uint8_t>(x << 4);
    high = static_cast<uint8_t>(low ^ upper ^ (x >> 3));
    low = static_cast<uint8_t>(x ^ (upper << 1));
  }
  return static_cast<uint16_t>(high << 8 | low);
}

}  // namespace firmware
}  // namespace thimble
