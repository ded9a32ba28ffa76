#pragma once

#include <stddef.h>
#include <stdint.h>
#include <string.h>

namespace thimble {
namespace firmware {

// Little-endian fields of messages. Each processor of the firmware is little endian; a build for
// another one fails (packet.cpp).

/// Writes a number at `to`.
template <class Number>
inline void put(uint8_t* to, Number value) noexcept {
  memcpy(to, &value, sizeof value);
}

/// Reads a number at `from`.
template <class Number>
inline Number get(const uint8_t* from) noexcept {
  Number value;
  memcpy(&value, from, sizeof value);
  return value;
}

}  // namespace firmware
}  // namespace thimble
