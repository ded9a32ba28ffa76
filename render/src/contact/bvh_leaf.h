#pragma once

#include <cstddef>
#include <cstdint>

namespace thimble::render {

// How a child of a node in a TreeSearch names a leaf.
inline constexpr std::uint32_t kLeaf = 0x80000000u;
inline constexpr std::size_t kLeafMax = 4;

inline std::size_t first_place(std::uint32_t leaf) noexcept {
  return (leaf & ~kLeaf) >> 2;
}
inline std::size_t end_place(std::uint32_t leaf) noexcept {
  return first_place(leaf) + (leaf & 3u) + 1;
}

}  // namespace thimble::render
