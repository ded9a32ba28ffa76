#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>

#include "thimble/driver/result.h"

namespace thimble::studies {

/// A ring with bumps all over, about z; lengths in m. At u (around the ring) and v (around its
/// tube), both in rad, the tube's radius is tube_radius (1 + amplitude sin(waves_u u) sin(waves_v
/// v)). A surface of any number of triangles whose every point is known by itself.
struct BumpyRing {
  double ring_radius = 0.035;
  double tube_radius = 0.014;
  double amplitude = 0.05;
  int waves_around = 7;
  int waves_across = 3;

  /// Finds the point of the surface at (u, v), m. Real-time: safe.
  Eigen::Vector3d at(double u, double v) const noexcept;
  /// Finds the outward unit normal at (u, v). Real-time: safe.
  Eigen::Vector3d normal(double u, double v) const noexcept;
  /// Returns half the longest side of a box around the ring and the origin, m.
  double half_size() const noexcept { return ring_radius + tube_radius * (1 + amplitude); }
};

/// What a written ring is made of.
struct RingGrid {
  std::int32_t around = 0;  ///< Squares around the ring, a multiple of 32.
  std::int32_t across = 0;  ///< Squares around the tube, a multiple of 16.
  std::int32_t triangle_count() const noexcept { return 2 * around * across; }
};

/// Chooses the grid of nearly square cells that has about `triangles` triangles (at least 1024).
RingGrid ring_grid(const BumpyRing& ring, std::int64_t triangles);

/// Writes the ring as a page file, patch by patch: a page holds a patch of 32 x 16 squares, and
/// pages follow each other along a Morton curve. The mesh is never held: memory is a few bytes per
/// page, whatever the number of triangles. Fails, naming the file, if it cannot be written.
/// Real-time: never from the servo thread.
driver::Result<void> write_ring(const BumpyRing& ring, const RingGrid& grid,
                                const std::filesystem::path& file);

}  // namespace thimble::studies
