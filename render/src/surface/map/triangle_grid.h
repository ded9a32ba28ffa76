#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace thimble::render {

// Grid of a triangle whose sides are divided into `parts` equal parts: the point (i, k), with
// i + k <= parts, is a + i / parts (b - a) + k / parts (c - a). Points are ordered by i, then by k.

/// Returns the number of points of a grid.
constexpr std::size_t grid_points(std::size_t parts) noexcept {
  return (parts + 1) * (parts + 2) / 2;
}

/// Returns the index of the point (i, k) of a grid.
constexpr std::size_t grid_point(std::size_t parts, std::size_t i, std::size_t k) noexcept {
  return i * (2 * parts + 3 - i) / 2 + k;
}

/// Calls `add` with the three points of each part of a triangle, in the triangle's orientation.
template <class Add>
constexpr void for_each_part(std::size_t parts, Add&& add) {
  for (std::size_t i = 0; i < parts; ++i) {
    for (std::size_t k = 0; i + k < parts; ++k) {
      const std::size_t a = grid_point(parts, i, k), c = grid_point(parts, i, k + 1);
      const std::size_t b = grid_point(parts, i + 1, k);
      add(std::array{a, b, c});
      if (i + k + 1 < parts) add(std::array{b, grid_point(parts, i + 1, k + 1), c});
    }
  }
}

}  // namespace thimble::render
