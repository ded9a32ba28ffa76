#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "support/random.h"

namespace thimble::support {

/// Draws any 16-bit word.
inline std::int16_t any_word(Random& random) {
  return static_cast<std::int16_t>(static_cast<std::uint16_t>(random.bits() >> 48));
}

/// Draws any bytes.
inline std::vector<std::byte> any_bytes(Random& random, std::size_t size) {
  std::vector<std::byte> bytes(size);
  for (std::byte& byte : bytes) byte = static_cast<std::byte>(random.bits() >> 56);
  return bytes;
}

/// Damages bytes like a bad cable: one to four times, a bit is flipped, a byte is lost, doubled or
/// changed, or the end is cut off.
inline std::vector<std::byte> damaged(Random& random, std::vector<std::byte> bytes) {
  for (std::uint64_t k = 0; k <= (random.bits() >> 62); ++k) {
    if (bytes.empty()) {
      bytes.push_back(static_cast<std::byte>(random.bits() >> 56));
      continue;
    }
    const auto at = static_cast<std::ptrdiff_t>(random.bits() % bytes.size());
    auto& byte = bytes[static_cast<std::size_t>(at)];
    switch (random.bits() >> 61) {
      case 0:
      case 1:
        byte ^= static_cast<std::byte>(1U << (random.bits() >> 61));
        break;
      case 2:
        bytes.erase(bytes.begin() + at);
        break;
      case 3: {
        const std::byte copy = byte;
        bytes.insert(bytes.begin() + at, copy);
        break;
      }
      case 4:
        bytes.resize(static_cast<std::size_t>(at));
        break;
      case 5:
        bytes.insert(bytes.end(), bytes.begin(), bytes.begin() + at);
        break;
      default:
        byte = static_cast<std::byte>(random.bits() >> 56);
    }
  }
  return bytes;
}

}  // namespace thimble::support
