#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "compact_mesh/packed_surface.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::render {

// Page files: a closed surface cut into volumes, so that only what lies around the tip need be in
// memory [BP 4.1]. A volume is a run of kPageTriangles packed triangles that lie near each other in
// space.
//
//   header | one box per page | one checksum per page | padding to a page of the disk | pages
//
// Little endian, as the machine is; packed triangles as PackedTriangle lays them out. A file of
// another version, byte order or packed triangle is refused, and so is damage: on opening that of
// what stands before the pages, on reading that of a page.

/// How many packed triangles a page holds: 64 KiB, a size that disks read at full speed.
inline constexpr std::int32_t kPageTriangles = 1024;

/// The box of a page's triangles, in steps of the lattice, rounded outwards.
struct PageBox {
  std::array<float, 3> min;  ///< Lower corner.
  std::array<float, 3> max;  ///< Upper corner.
};

/// Finds the box of some packed triangles. Real-time: safe.
PageBox box_of(std::span<const PackedTriangle> triangles) noexcept;

/// Returns whether two boxes share a point; `low` and `high` in steps. NaN shares none.
/// Real-time: safe.
inline bool reaches(const PageBox& box, const Eigen::Vector3d& low,
                    const Eigen::Vector3d& high) noexcept {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<Eigen::Index>(axis);
    if (!(double{box.min[axis]} <= high[i] && double{box.max[axis]} >= low[i])) return false;
  }
  return true;
}

/// Finds the squared distance from a point to a box, in squared steps; 0 inside. Real-time: safe.
inline double distance_squared(const PageBox& box, const Eigen::Vector3d& p) noexcept {
  double sum = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double x = p[static_cast<Eigen::Index>(axis)];
    const double outside = std::max({double{box.min[axis]} - x, x - double{box.max[axis]}, 0.0});
    sum += outside * outside;
  }
  return sum;
}

/// Finds the squared distance from a point to the farthest corner of a box, in squared steps.
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

/// The lattice of a surface: where its middle lies and how long one step is, m in W.
struct Lattice {
  Eigen::Vector3d origin{0, 0, 0};  ///< Of the lattice.
  double step = 0;                  ///< Of the lattice.

  /// Returns where corner `k` of a packed triangle is, m in W; the same as PackedSurface::position.
  Eigen::Vector3d position(const PackedTriangle& packed, std::size_t k) const noexcept {
    return origin + step * packed.corner(k);
  }
};

/// Writes a page file packed triangle by packed triangle, for surfaces that fit no memory.
/// Real-time: never from the servo thread.
class THIMBLE_EXPORT PageFileWriter {
 public:
  /// Begins a file for `triangle_count` packed triangles (> 0). Fails, naming the file, if it
  /// cannot be written.
  static driver::Result<PageFileWriter> create(const std::filesystem::path& file,
                                               const Lattice& lattice, std::int64_t triangle_count);

  PageFileWriter(PageFileWriter&&) noexcept;             ///< Takes it over.
  PageFileWriter& operator=(PageFileWriter&&) noexcept;  ///< Takes it over.
  ~PageFileWriter();

  /// Adds packed triangles in the order of their numbers. Fails when the disk is full.
  driver::Result<void> append(std::span<const PackedTriangle> triangles);

  /// Writes what is left and the boxes. Fails if the number of packed triangles is not the one
  /// promised.
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

/// Returns whether a file begins as a page file does; false if it cannot be read.
/// Real-time: never from the servo thread.
THIMBLE_EXPORT bool is_page_file(const std::filesystem::path& file);

/// An open page file: what stands before the packed triangles, in memory.
/// Real-time: never from the servo thread.
class THIMBLE_EXPORT PageFile {
 public:
  /// Opens a file. Fails, with what to do, if it cannot be read, is no page file, is cut short, or
  /// holds numbers that cannot be.
  static driver::Result<PageFile> open(const std::filesystem::path& file);

  PageFile(PageFile&& other) noexcept;             ///< Takes it over.
  PageFile& operator=(PageFile&& other) noexcept;  ///< Takes it over.
  ~PageFile();

  /// Reads a page's packed triangles; `triangles` must have room for `kPageTriangles`. Returns
  /// how many it holds, or 0 if the disk failed, the page is damaged, or a packed triangle names a
  /// neighbour that cannot be.
  std::int32_t read_page(std::int32_t page, std::span<PackedTriangle> triangles) const noexcept;

  /// Asks the kernel to bring a page near, for a `read_page` soon: so the disk works on several.
  void announce_page(std::int32_t page) const noexcept;

  const Lattice& lattice() const noexcept { return lattice_; }  ///< Returns the lattice.
  std::int32_t triangle_count() const noexcept { return triangle_count_; }
  /// Returns how far the smooth surface rises above its triangles, m in W; as PackedSurface::rise.
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
