#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

namespace thimble::render {

/// An upright box in steps of a SearchFrame; empty until something is added.
struct LatticeAabb {
  LatticeAabb() noexcept;
  /// Makes the box hold a point. Real-time: safe.
  void add(double x, double y, double z) noexcept;
  /// Makes the box hold another. Real-time: safe.
  void add(const LatticeAabb& box) noexcept;

  std::array<double, 3> min, max;  ///< Its corners, steps.
};

/// A node of a TreeSearch in one line of the cache: the boxes of up to eight children, rounded
/// outwards to 1/255 of the node's own size. Which children these are follows from its place.
///
///     byte 0        12                16                      64
///     | origin      | scale, children | sides                  |
struct alignas(64) BoxNode {
  static constexpr std::size_t kChildrenMax = 8;        ///< Most.
  using Side = std::array<std::uint8_t, kChildrenMax>;  ///< One side of all children.

  std::array<float, 3> origin{};  ///< Where sides count from, in steps.
  /// The bits of a float, a power of two: steps per unit of a side; in the lowest eight bits
  /// those of the children that are there.
  std::uint32_t scale_and_children = 0;
  /// Low x, y, z, then high x, y, z of each child, in units above the origin; of a child that is
  /// not there those of the last one.
  std::array<Side, 6> sides{};

  /// Returns how many steps a unit of a side has: a power of two. Real-time: safe.
  float scale() const noexcept { return std::bit_cast<float>(scale_and_children & ~kChildren); }
  /// Returns which children are there, in bits. Real-time: safe.
  unsigned children() const noexcept { return scale_and_children & kChildren; }

  /// Sets the boxes of the first children. Precondition: one to `kChildrenMax`, none empty.
  /// Real-time: safe.
  void set_boxes(std::span<const LatticeAabb> boxes) noexcept;
  /// Returns the box around all children, as rounded. Real-time: safe.
  LatticeAabb box() const noexcept;

  bool operator==(const BoxNode&) const noexcept = default;  ///< Compares all. Real-time: safe.

 private:
  static constexpr std::uint32_t kChildren = 0xffu;
};
static_assert(sizeof(BoxNode) == 64);

}  // namespace thimble::render
