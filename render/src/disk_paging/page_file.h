#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "compact_mesh/packed_surface.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::render {

// Page files: a closed surface cut into pages, so that only the part around the tip must be in
// memory [BP 4.1]. A page has kPageTriangles consecutive packed triangles that are near each other
// in space.
//
//   header | one box per page | one checksum per page | padding to a page of the disk | pages
//
// Little endian; packed triangles have the layout of PackedTriangle. A file with another version,
// byte order or packed triangle is refused. Damage is detected: when opening, in the data before
// the pages; when reading, in a page.

/// Number of packed triangles per page: 64 KiB, a size that disks read at full speed.
inline constexpr std::int32_t kPageTriangles = 1024;
/// Bytes of a page.
inline constexpr std::size_t kPageBytes = kPageTriangles * sizeof(PackedTriangle);

/// The box of a page's triangles, in steps of the lattice, rounded outwards.
struct PageBox {
  std::array<float, 3> min;  ///< Lower corner.
  std::array<float, 3> max;  ///< Upper corner.
};

/// Returns the box of some packed triangles. Real-time: safe.
PageBox box_of(std::span<const PackedTriangle> triangles) noexcept;

/// Returns whether two boxes share a point; `low` and `high` in steps. False for NaN. Real-time:
/// safe.
inline bool reaches(const PageBox& box, const Eigen::Vector3d& low,
                    const Eigen::Vector3d& high) noexcept {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<Eigen::Index>(axis);
    if (!(double{box.min[axis]} <= high[i] && double{box.max[axis]} >= low[i])) return false;
  }
  return true;
}

/// Returns the squared distance from a point to a box, in squared steps; 0 inside. Real-time: safe.
inline double distance_squared(const PageBox& box, const Eigen::Vector3d& p) noexcept {
  double sum = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double x = p[static_cast<Eigen::Index>(axis)];
    const double outside = std::max({double{box.min[axis]} - x, x - double{box.max[axis]}, 0.0});
    sum += outside * outside;
  }
  return sum;
}

/// Returns the squared distance from a point to the farthest corner of a box, in squared steps.
/// Real-time: safe.
inline double farthest_squared(const PageBox& box, const Eigen::Vector3d& p) noexcept {
  double sum = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double x = p[static_cast<Eigen::Index>(axis)];
    const double far = std::max(x - double{box.min[axis]}, double{box.max[axis]} - x);
    sum += far * far;
  }
  return sum;
}

/// The lattice of a surface: the position of its middle and the length of a step, m in W.
struct Lattice {
  Eigen::Vector3d origin{0, 0, 0};  ///< Middle of the lattice, m in W.
  double step = 0;                  ///< Length of a step, m.

  /// Returns the position of corner `k` of a packed triangle, m in W; the same as
  /// PackedSurface::position.
  Eigen::Vector3d position(const PackedTriangle& packed, std::size_t k) const noexcept {
    return origin + step * packed.corner(k);
  }
};

/// Writes a page file incrementally, for surfaces that do not fit into memory. Real-time: never
/// from the servo thread.
class THIMBLE_EXPORT PageFileWriter {
 public:
  /// Begins a file for `triangle_count` packed triangles (> 0). Fails, naming the file, if it
  /// cannot be written.
  static driver::Result<PageFileWriter> create(const std::filesystem::path& file,
                                               const Lattice& lattice, std::int64_t triangle_count);

  PageFileWriter(PageFileWriter&&) noexcept;             ///< Moves the writer.
  PageFileWriter& operator=(PageFileWriter&&) noexcept;  ///< Moves the writer.
  ~PageFileWriter();

  /// Adds packed triangles in the order of their numbers. Fails when the disk is full.
  driver::Result<void> append(std::span<const PackedTriangle> triangles);

  /// Writes the remaining data and the boxes. Fails if the number of packed triangles differs from
  /// `triangle_count`.
  driver::Result<void> finish();

 private:
  struct State;
  explicit PageFileWriter(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// Writes a whole surface. Fails, naming the file, if it cannot be written.
/// Real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<void> write_page_file(const PackedSurface& surface,
                                                    const std::filesystem::path& file);

/// Returns whether a file begins like a page file; false if it cannot be read. Real-time: never
/// from the servo thread.
THIMBLE_EXPORT bool is_page_file(const std::filesystem::path& file);

/// An open page file: the data before the packed triangles, in memory. Real-time: never from the
/// servo thread.
class THIMBLE_EXPORT PageFile {
 public:
  /// Opens a file. Fails, with a remedy, if it cannot be read, is not a page file, is truncated, or
  /// has invalid numbers.
  static driver::Result<PageFile> open(const std::filesystem::path& file);

  PageFile(PageFile&& other) noexcept;             ///< Moves the file.
  PageFile& operator=(PageFile&& other) noexcept;  ///< Moves the file.
  ~PageFile();

  /// Reads a page's packed triangles; `triangles` must have room for `kPageTriangles`. Returns
  /// their number, or 0 if the disk failed, the page is damaged, or a packed triangle names an
  /// invalid neighbour.
  std::int32_t read_page(std::int32_t page, std::span<PackedTriangle> triangles) const noexcept;

  /// Asks the kernel to read ahead a page for a later `read_page`, so that the disk works on
  /// several.
  void announce_page(std::int32_t page) const noexcept;

  const Lattice& lattice() const noexcept { return lattice_; }  ///< Returns the lattice.
  std::int32_t triangle_count() const noexcept { return triangle_count_; }
  /// Returns the maximum height of the smooth surface above its triangles, m in W; as
  /// PackedSurface::rise.
  double rise() const noexcept { return rise_; }
  /// Returns the box around the whole surface, in steps.
  const PageBox& whole() const noexcept { return whole_; }
  /// Returns the box of each page, in steps.
  const std::vector<PageBox>& boxes() const noexcept { return boxes_; }

 private:
  PageFile() = default;

  int descriptor_ = -1;
  Lattice lattice_;
  std::int32_t triangle_count_ = 0;
  std::int64_t records_at_ = 0;
  double rise_ = 0;
  PageBox whole_{};
  std::vector<PageBox> boxes_;
  std::vector<std::uint64_t> sums_;
};

}  // namespace thimble::render
