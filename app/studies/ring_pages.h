#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>

#include "thimble/driver/result.h"

namespace thimble::studies {

/// A ring with bumps, about z; lengths in m. At u (around the ring) and v (around its tube), both
/// in rad, the tube's radius is tube_radius (1 + amplitude sin(waves_u u) sin(waves_v v)). A
/// surface of any number of triangles in which every point can be computed separately.
struct BumpyRing {
  double ring_radius = 0.035;
  double tube_radius = 0.014;
  double amplitude = 0.05;
  int waves_around = 7;
  int waves_across = 3;

  /// Returns the point of the surface at (u, v), m. Real-time: safe.
  Eigen::Vector3d at(double u, double v) const noexcept;
  /// Returns the outward unit normal at (u, v). Real-time: safe.
  Eigen::Vector3d normal(double u, double v) const noexcept;
  /// Returns half the longest side of a box that contains the ring and is centred at the origin, m.
  double half_size() const noexcept { return ring_radius + tube_radius * (1 + amplitude); }
};

/// Resolution of a written ring.
struct RingGrid {
  std::int32_t around = 0;  ///< Squares around the ring, a multiple of 32.
  std::int32_t across = 0;  ///< Squares around the tube, a multiple of 16.
  std::int32_t triangle_count() const noexcept { return 2 * around * across; }
};

/// Returns the grid of nearly square cells with about `triangles` triangles (at least 1024).
RingGrid ring_grid(const BumpyRing& ring, std::int64_t triangles);

/// Writes the ring as a page file, patch by patch: a page contains a patch of 32 x 16 squares, and
/// pages follow a Morton curve. The mesh is never in memory as a whole: memory is a few bytes per
/// page, whatever the number of triangles. The error names the file. Real-time: never from the
/// servo thread.
driver::Result<void> write_ring(const BumpyRing& ring, const RingGrid& grid,
                                const std::filesystem::path& file);

}  // namespace thimble::studies
