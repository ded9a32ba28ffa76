#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <unordered_map>
#include <vector>

namespace thimble::render {

/// Lists, per vertex, the sides of triangles that begin there. Gives neighbours in O(n), where
/// sorting all edges takes several times as long. Real-time: never from the servo thread.
class HalfEdges {
 public:
  /// A side of a triangle without its begin.
  struct Side {
    std::int32_t end;
    std::int32_t triangle;
  };

  HalfEdges(const std::vector<std::array<std::int32_t, 3>>& triangles, std::size_t vertices)
      : HalfEdges(
            triangles.size(),
            vertices, [&triangles](std::size_t t) -> const auto& { return triangles[t]; }) {}

  /// Takes triangles from a function instead of an array. `corners_of(t)` returns the three
  /// vertices of triangle `t`.
  template <class CornersOf>
  HalfEdges(std::size_t triangles, std::size_t vertices, const CornersOf& corners_of)
      : begin_(vertices + 2, 0), sides_(std::make_unique_for_overwrite<Side[]>(3 * triangles)) {
    for (std::size_t t = 0; t < triangles; ++t) {
      for (const std::int32_t v : corners_of(t)) ++begin_[static_cast<std::size_t>(v) + 2];
    }
    for (std::size_t v = 2; v < begin_.size(); ++v) begin_[v] += begin_[v - 1];
    for (std::size_t t = 0; t < triangles; ++t) {
      const std::array<std::int32_t, 3>& corners = corners_of(t);
      for (std::size_t k = 0; k < 3; ++k) {
        const auto v = static_cast<std::size_t>(corners[k]);
        sides_[begin_[v + 1]++] = {corners[k == 2 ? 0 : k + 1], static_cast<std::int32_t>(t)};
      }
    }
    for (std::size_t v = 0; v < vertices; ++v) {
      const std::span<const Side> sides = around(static_cast<std::int32_t>(v));
      if (sides.size() <= kHub) continue;
      std::vector<Side>& sorted = hubs_[static_cast<std::int32_t>(v)];
      sorted.assign(sides.begin(), sides.end());
      std::sort(sorted.begin(), sorted.end(), by_end);
    }
  }

  /// Lists the sides that begin at a vertex; one per triangle around it.
  std::span<const Side> around(std::int32_t vertex) const noexcept {
    const auto v = static_cast<std::size_t>(vertex);
    return {sides_.get() + begin_[v], begin_[v + 1] - begin_[v]};
  }

  /// Returns the only triangle with the edge from `from` to `to`; -1 if there is none or several.
  std::int32_t opposite(std::int32_t from, std::int32_t to) const noexcept {
    const std::span<const Side> sides = around(from);
    if (sides.size() > kHub) return only_one(hubs_.find(from)->second, to);
    std::int32_t found = -1;
    for (const Side& side : sides) {
      if (side.end != to) continue;
      if (found >= 0) return -1;
      found = side.triangle;
    }
    return found;
  }

 private:
  // The sides at a vertex are sorted if there are more than this: a hub of n triangles would cost
  // n^2 otherwise.
  static constexpr std::size_t kHub = 64;

  static bool by_end(const Side& a, const Side& b) noexcept { return a.end < b.end; }

  static std::int32_t only_one(std::span<const Side> sorted, std::int32_t to) noexcept {
    const auto [first, last] = std::equal_range(sorted.begin(), sorted.end(), Side{to, -1}, by_end);
    return last - first == 1 ? first->triangle : -1;
  }

  std::vector<std::uint32_t> begin_;
  std::unique_ptr<Side[]> sides_;
  std::unordered_map<std::int32_t, std::vector<Side>>
      hubs_;  // of vertices with many sides, sorted by their ends
};

}  // namespace thimble::render
