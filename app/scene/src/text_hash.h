#pragma once

#include <cstdint>
#include <string_view>

namespace thimble::scene {

/// Returns a non-cryptographic hash of a text, for file names. FNV-1a, 64 bits [S Fowler, Noll, Vo;
/// public domain constants].
constexpr std::uint64_t text_hash(std::string_view text) noexcept {
  std::uint64_t sum = 0xcbf29ce484222325;
  for (const char c : text) sum = (sum ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  return sum;
}

}  // namespace thimble::scene
