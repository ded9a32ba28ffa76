#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace thimble::render {

/// Is a number with the key it is sorted by.
struct KeyedIndex {
  std::uint64_t key;
  std::int32_t index;
};

/// Sorts by the lowest 48 bits of the keys; equal keys keep their order. O(n).
/// Real-time: never from the servo thread.
inline void radix_sort(std::vector<KeyedIndex>& items) {
  // Four passes of twelve bits: the counters of one pass still fit into the first cache.
  constexpr int kDigit = 12;
  constexpr std::size_t kValues = std::size_t{1} << kDigit;
  std::vector<KeyedIndex> sorted(items.size());
  for (int shift = 0; shift < 48; shift += kDigit) {
    std::array<std::size_t, kValues> begin{};
    for (const KeyedIndex& item : items) ++begin[(item.key >> shift) % kValues];
    std::size_t sum = 0;
    for (std::size_t& b : begin) {
      const std::size_t size = b;
      b = sum;
      sum += size;
    }
    for (const KeyedIndex& item : items) sorted[begin[(item.key >> shift) % kValues]++] = item;
    items.swap(sorted);
  }
}

}  // namespace thimble::render
