#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "search/eight_triangles.h"

namespace thimble::render {

/// Counts the ones of a word without popcnt, which not every x86-64 has. Real-time: safe.
inline std::uint32_t count_ones(std::uint64_t v) noexcept {
  v -= (v >> 1) & 0x5555555555555555u;
  v = (v & 0x3333333333333333u) + ((v >> 2) & 0x3333333333333333u);
  v = (v + (v >> 4)) & 0x0f0f0f0f0f0f0f0fu;
  return static_cast<std::uint32_t>((v * 0x0101010101010101u) >> 56);
}

/// The triangles that reach into one volume.
struct VolumeList {
  std::span<const std::int32_t> triangles;  ///< In ascending order.
  const EightTriangles* eights = nullptr;   ///< The same triangles in groups of eight.
  Eigen::Vector3d middle;                   ///< Middle of the volume.
};

/// Space divided into volumes (cubes) with the triangles that reach into each [BP 4.1]. Volumes are
/// in blocks of 4 x 4 x 4:
///
///     top: one word per block of the box  ->  block: which of its 64 volumes hold anything
///          (empty: how far all is empty)      ->  volume: where its list begins  ->  triangles
///
/// So empty space takes no memory but the word per block, and a query near the surface costs three
/// cache lines plus the triangles. A triangle is listed in every volume that it reaches into when
/// thickened by `kGridRoom` of a volume. Lengths are steps of a SearchFrame.
class VolumeGrid {
 public:
  /// One block: bit x + 4 y + 16 z is set if that volume lists anything.
  struct Block {
    std::uint64_t occupied = 0;      ///< One bit for each volume.
    std::uint32_t first_volume = 0;  ///< Index of its first occupied volume in `begins`.
  };
  /// Marks a word of `top` as an empty block. The other bits are the distance in blocks to the
  /// nearest block that is not empty, along the axis of the largest distance, at most `kFarthest`.
  static constexpr std::uint32_t kEmpty = 0x80000000u;
  static constexpr std::uint32_t kFarthest = 255;  ///< Maximum distance stored, blocks.
  /// Maximum number of blocks along an axis.
  static constexpr std::int32_t kBlocksMax = 1024;

  /// Begin of the list of a volume.
  struct ListBegin {
    std::uint32_t triangle = 0;  ///< In `triangles`.
    std::uint32_t eight = 0;     ///< In `eights`.
  };
  /// Data of a grid; see build_volume_grid.
  struct Parts {
    Eigen::Vector3d low{0, 0, 0};                 ///< The low corner of the grid.
    double side = 1;                              ///< Side of a volume.
    double per_unit = 1;                          ///< Units of EightTriangles per step.
    std::array<std::int32_t, 3> blocks{1, 1, 1};  ///< Number of blocks along each axis.
    std::vector<std::uint32_t> top;               ///< Word of each block: its index, or the
                                                  ///< distance to the next one.
    std::vector<Block> all_blocks;                ///< Blocks that are not empty.
    std::vector<ListBegin> begins;                ///< Per occupied volume; one more at the end.
    std::vector<std::int32_t> triangles;          ///< Lists of the volumes, each ascending.
    std::vector<EightTriangles> eights;           ///< Their corners; each list begins a new one.
  };

  /// Returns the low corner of volume `i` of a block, x + 4 y + 16 z as in Block::occupied, from
  /// the block's position along each axis.
  static Eigen::Vector3d corner_of(const Parts& parts, std::int32_t x, std::int32_t y,
                                   std::int32_t z, std::int32_t i) noexcept {
    return parts.low +
           parts.side * Eigen::Vector3d(4 * x + (i & 3), 4 * y + ((i >> 2) & 3), 4 * z + (i >> 4));
  }
  /// Returns the middle of a volume from its low corner: the origin of its triangles.
  static Eigen::Vector3d middle_of(const Parts& parts, const Eigen::Vector3d& corner) noexcept {
    return corner + Eigen::Vector3d::Constant(parts.side / 2);
  }

  explicit VolumeGrid(Parts parts) noexcept : parts_(std::move(parts)) {
    per_side_ = 1 / parts_.side;
    for (int i = 0; i < 3; ++i) {
      last_[i] = 4 * parts_.blocks[static_cast<std::size_t>(i)] - 1;
      high_[i] = parts_.low[i] + parts_.side * (last_[i] + 1);
    }
  }

  double side() const noexcept { return parts_.side; }    ///< Returns the side of a volume, m.
  const Parts& parts() const noexcept { return parts_; }  ///< Returns the data of the grid.

  /// Returns the bytes of memory held.
  std::size_t bytes() const noexcept {
    return parts_.top.capacity() * sizeof(std::uint32_t) +
           parts_.all_blocks.capacity() * sizeof(Block) +
           parts_.begins.capacity() * sizeof(ListBegin) +
           parts_.triangles.capacity() * sizeof(std::int32_t) +
           parts_.eights.capacity() * sizeof(EightTriangles);
  }

  /// Returns the volume of a coordinate; beyond the grid, its outermost volume. Monotone. NaN is in
  /// the first. Real-time: safe.
  std::int32_t volume_of(double u, int axis) const noexcept {
    const double v = (u - parts_.low[axis]) * per_side_;
    // No branches.
    return static_cast<std::int32_t>(std::min(v > 0 ? v : 0.0, last_[axis]));
  }

  /// A volume by its position along each axis.
  using Place = std::array<std::int32_t, 3>;
  /// Returns the volume of a point (volume_of). Real-time: safe.
  Place place_of(const Eigen::Vector3d& p) const noexcept {
    return {volume_of(p.x(), 0), volume_of(p.y(), 1), volume_of(p.z(), 2)};
  }
  /// Returns the low corner of a volume. Real-time: safe.
  Eigen::Vector3d corner_of(const Place& place) const noexcept {
    const auto [x, y, z] = place;
    return corner_of(parts_, x >> 2, y >> 2, z >> 2, number_in_block(place));
  }
  /// Returns whether a box meets the grid; one with a NaN does not. Real-time: safe.
  bool meets(const Eigen::Vector3d& low, const Eigen::Vector3d& high) const noexcept {
    bool all = true;
    for (int i = 0; i < 3; ++i) {
      all &= low[i] <= high_[i];
      all &= high[i] >= parts_.low[i];
    }
    return all;
  }

  /// Calls visit(list) for a volume if it is occupied. Real-time: safe.
  template <class Visit>
  void visit_one(const Place& place, Visit visit) const noexcept;
  /// Calls visit(list) for each occupied volume between two positions along each axis for which
  /// wanted(corner) is true; corner is the volume's low corner. A triangle may be in several lists.
  /// Real-time: safe; its time grows with the blocks between.
  template <class Wanted, class Visit>
  void visit_between(const Place& first, const Place& last, Wanted wanted,
                     Visit visit) const noexcept;
  /// The same for the volumes that meet a box.
  template <class Wanted, class Visit>
  void visit_box(const Eigen::Vector3d& low, const Eigen::Vector3d& high, Wanted wanted,
                 Visit visit) const noexcept {
    if (meets(low, high)) visit_between(place_of(low), place_of(high), wanted, visit);
  }

  /// Returns the distance of a point from the border of its volume; not above 0 outside the grid.
  /// Real-time: safe.
  double within_volume(const Eigen::Vector3d& p) const noexcept {
    double least = parts_.side;
    for (int i = 0; i < 3; ++i) {
      const double begin = parts_.low[i] + parts_.side * volume_of(p[i], i);
      least = std::min(least, std::min(p[i] - begin, begin + parts_.side - p[i]));
    }
    return least;
  }

  /// Returns a distance from a point within which all blocks are empty; 0 near the surface.
  /// Real-time: safe; one cache line.
  double clearance(const Eigen::Vector3d& p) const noexcept;

 private:
  static std::int32_t number_in_block(const Place& place) noexcept {
    return (place[0] & 3) | (place[1] & 3) << 2 | (place[2] & 3) << 4;
  }
  std::size_t top_place(std::int32_t x, std::int32_t y, std::int32_t z) const noexcept {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(parts_.blocks[1]) +
            static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(parts_.blocks[0]) +
           static_cast<std::size_t>(x);
  }
  VolumeList list(const Block& block, std::uint64_t bit,
                  const Eigen::Vector3d& corner) const noexcept {
    const std::size_t v = block.first_volume + count_ones(block.occupied & (bit - 1));
    const ListBegin begin = parts_.begins[v];
    const std::uint32_t count = parts_.begins[v + 1].triangle - begin.triangle;
    return {{parts_.triangles.data() + begin.triangle, count},
            parts_.eights.data() + begin.eight,
            middle_of(parts_, corner)};
  }

  Parts parts_;
  double per_side_ = 1;
  Eigen::Vector3d last_{0, 0, 0};  // position of the outermost volume along each axis
  Eigen::Vector3d high_{0, 0, 0};
};

/// Margin, as a share of a volume's side, within which triangles count as reaching. It covers the
/// rounding of places in the grid (2^-52 of 2^12 volumes) by far.
inline constexpr double kGridRoom = 0x1p-16;

template <class Visit>
inline void VolumeGrid::visit_one(const Place& place, Visit visit) const noexcept {
  const auto [x, y, z] = place;
  const std::uint32_t word = parts_.top[top_place(x >> 2, y >> 2, z >> 2)];
  if ((word & kEmpty) != 0) return;
  const Block& block = parts_.all_blocks[word];
  const std::uint64_t bit = std::uint64_t{1} << number_in_block(place);
  if ((block.occupied & bit) != 0) visit(list(block, bit, corner_of(place)));
}

template <class Wanted, class Visit>
inline void VolumeGrid::visit_between(const Place& first, const Place& last, Wanted wanted,
                                      Visit visit) const noexcept {
  // Mask of all positions between two along an axis of a block, with `shift` bits per position.
  const auto between = [](std::int32_t from, std::int32_t to, int shift) noexcept {
    const int end = (to + 1) << shift, begin = from << shift;
    return (~std::uint64_t{0} >> (64 - end)) & (~std::uint64_t{0} << begin);
  };
  const auto part = [&](std::size_t axis, std::int32_t block, int shift) noexcept {
    const std::int32_t from = std::max(first[axis] - 4 * block, 0);
    const std::int32_t to = std::min(last[axis] - 4 * block, 3);
    return between(from, to, shift);
  };
  for (std::int32_t z = first[2] >> 2; z <= last[2] >> 2; ++z) {
    const std::uint64_t layers = part(2, z, 4);
    for (std::int32_t y = first[1] >> 2; y <= last[1] >> 2; ++y) {
      const std::uint64_t rows = layers & (part(1, y, 2) * 0x0001000100010001u);
      for (std::int32_t x = first[0] >> 2; x <= last[0] >> 2; ++x) {
        const std::uint32_t word = parts_.top[top_place(x, y, z)];
        if ((word & kEmpty) != 0) continue;
        const Block& block = parts_.all_blocks[word];
        std::uint64_t left = block.occupied & rows & (part(0, x, 0) * 0x1111111111111111u);
        for (; left != 0; left &= left - 1) {
          const auto i = std::countr_zero(left);
          const Eigen::Vector3d corner = corner_of(parts_, x, y, z, i);
          if (wanted(corner)) visit(list(block, left & (~left + 1), corner));
        }
      }
    }
  }
}

inline double VolumeGrid::clearance(const Eigen::Vector3d& p) const noexcept {
  std::array<std::int32_t, 3> at;
  double beside = 0;
  for (int i = 0; i < 3; ++i) {
    at[static_cast<std::size_t>(i)] = volume_of(p[i], i) >> 2;
    beside = std::max({beside, parts_.low[i] - p[i], p[i] - high_[i]});
  }
  if (beside > 0) return beside;
  const std::uint32_t word = parts_.top[top_place(at[0], at[1], at[2])];
  if ((word & kEmpty) == 0) return 0;
  const double block = 4 * parts_.side;
  double border = block;
  for (int i = 0; i < 3; ++i) {
    const double in = p[i] - parts_.low[i] - block * at[static_cast<std::size_t>(i)];
    border = std::min({border, in, block - in});
  }
  const double clear = (static_cast<double>(word & ~kEmpty) - 1) * block + border;
  return std::max(clear - parts_.side * kGridRoom, 0.0);
}

}  // namespace thimble::render
