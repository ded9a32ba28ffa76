#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace thimble::render {

/// Is an upright box in steps of a SearchFrame; empty until something is added.
struct StepBox {
  StepBox() noexcept;
  /// Makes the box hold a point. Real-time: safe.
  void add(double x, double y, double z) noexcept;
  /// Makes the box hold another. Real-time: safe.
  void add(const StepBox& box) noexcept;

  std::array<double, 3> min, max;  ///< Its corners, steps.
};

/// Is a node of a TreeSearch: the boxes of up to eight children, rounded outwards to 1/255 of the
/// node's own size, so that they take 96 bytes together.
///
///     byte 0        12      16                      64              96
///     | origin      | scale | sides                  | children      |
struct alignas(32) BoxNode {
  static constexpr std::size_t kChildrenMax = 8;        ///< Most.
  using Side = std::array<std::uint8_t, kChildrenMax>;  ///< One side of all children.

  std::array<float, 3> origin{};  ///< Where sides count from, in steps.
  float scale = 1;                ///< Steps per unit of a side: a power of two.
  /// Low x, y, z, then high x, y, z of each child, in units above the origin.
  std::array<Side, 6> sides{};
  /// Number of a node, 0 for no child (the root is nobody's); or kLeaf | first place << 2 |
  /// triangles - 1, where places count along the tree's order of triangles.
  std::array<std::uint32_t, kChildrenMax> children{};

  static constexpr std::uint32_t kLeaf = 0x80000000u;  ///< Marks a leaf.
  static constexpr std::size_t kLeafMax = 4;           ///< Most triangles of a leaf.

  /// Sets the boxes of the first children. Precondition: at most `kChildrenMax`, none empty.
  /// Real-time: safe.
  void set_boxes(std::span<const StepBox> boxes) noexcept;
};
static_assert(sizeof(BoxNode) == 96);

/// Names a leaf. Precondition: 1 to `kLeafMax` triangles. Real-time: safe.
inline std::uint32_t leaf_of(std::size_t first_place, std::size_t triangles) noexcept {
  return BoxNode::kLeaf | static_cast<std::uint32_t>(first_place << 2) |
         static_cast<std::uint32_t>(triangles - 1);
}
/// Tells where a leaf's triangles begin and end in the tree's order. Real-time: safe.
inline std::size_t first_place(std::uint32_t leaf) noexcept {
  return (leaf & ~BoxNode::kLeaf) >> 2;
}
inline std::size_t end_place(std::uint32_t leaf) noexcept {
  return first_place(leaf) + (leaf & 3u) + 1;
}

}  // namespace thimble::render
