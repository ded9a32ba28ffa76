#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

namespace thimble::render {

/// An upright box in steps of a SearchFrame; empty until a point is added.
struct LatticeAabb {
  LatticeAabb() noexcept;
  /// Extends the box to a point. Real-time: safe.
  void add(double x, double y, double z) noexcept;
  /// Extends the box to another box. Real-time: safe.
  void add(const LatticeAabb& box) noexcept;

  std::array<double, 3> min, max;  ///< Its corners, steps.
};

/// A node of a TreeSearch in one cache line: the boxes of up to eight children, rounded outwards to
/// 1/255 of the node's own size. The node's position determines its children.
///
///     byte 0        12                16                      64
///     | origin      | scale, children | sides                  |
struct alignas(64) BoxNode {
  static constexpr std::size_t kChildrenMax = 8;        ///< Maximum number of children.
  using Side = std::array<std::uint8_t, kChildrenMax>;  ///< One side of all children.

  std::array<float, 3> origin{};  ///< Origin of the sides, in steps.
  /// The bits of a float, a power of two: steps per unit of a side. The lowest eight bits are the
  /// mask of the existing children.
  std::uint32_t scale_and_children = 0;
  /// Low x, y, z, then high x, y, z of each child, in units above the origin. A child that does not
  /// exist has those of the last one.
  std::array<Side, 6> sides{};

  /// Returns the number of steps per unit of a side: a power of two. Real-time: safe.
  float scale() const noexcept { return std::bit_cast<float>(scale_and_children & ~kChildren); }
  /// Returns the mask of the existing children. Real-time: safe.
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
