#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace thimble::render {

/// Numbers of nodes or triangles that a query has found on one level of a tree.
struct NearList {
  static constexpr std::size_t kCapacity = 64;  ///< Capacity.
  std::array<std::uint32_t, kCapacity> numbers;
  std::array<float, kCapacity> nears;  ///< Squared distances, for closest-point queries.
  std::size_t count = 0;
};

/// For each of the 256 sets of eight bits: the numbers of the set bits, one per byte, the lowest
/// first.
inline constexpr std::array<std::uint64_t, 256> kSetBits = [] {
  std::array<std::uint64_t, 256> all{};
  for (std::size_t set = 0; set < all.size(); ++set) {
    int place = 0;
    for (std::uint64_t bit = 0; bit < 8; ++bit) {
      if (((set >> bit) & 1u) != 0) all[set] |= bit << (8 * place++);
    }
  }
  return all;
}();

/// For each set of eight bits: its lowest four set bits.
inline constexpr std::array<std::uint8_t, 256> kFirstFour = [] {
  std::array<std::uint8_t, 256> all{};
  for (unsigned set = 0; set < all.size(); ++set) {
    unsigned left = set;
    for (int i = 0; i < 4; ++i) left &= left - (left != 0 ? 1 : 0);
    all[set] = static_cast<std::uint8_t>(set & ~left);
  }
  return all;
}();

}  // namespace thimble::render
