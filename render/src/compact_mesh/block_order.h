#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace thimble::render {

/// A numbered place. In any unit; finite.
struct alignas(16) PlacedIndex {
  std::array<float, 3> at;
  std::int32_t index;
};

/// Sorts places such that each eight, each 64, each 512 of them and so on, counted from the begin,
/// are close together in space. Halves a part across its longest side until eight are left. These
/// are the nodes of TreeNodes, and neighbours in space are near in memory. Equal places are ordered
/// by their numbers. O(n log n), some 50 ns each at 10^6. Real-time: never from the servo thread.
void order_in_blocks(std::span<PlacedIndex> items);

}  // namespace thimble::render
