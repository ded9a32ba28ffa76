#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>

#include "search/nearest_so_far.h"

namespace thimble::render {

/// Corners of up to eight triangles, relative to the middle of a volume and rounded to a unit. A
/// segment is tested against eight at a time, to drop those that it does not cross before any of
/// them is read.
struct alignas(16) EightTriangles {
  static constexpr std::size_t kCapacity = 8;     ///< Maximum number of triangles.
  static constexpr double kFarthestUnit = 32700;  ///< Maximum of a corner from the middle, in
                                                  ///< units.
  using Lanes = std::array<std::int16_t, kCapacity>;
  std::array<Lanes, 3> x{}, y{}, z{};  ///< Coordinates of corner k, one triangle per lane.

  /// Stores a triangle in a lane. Corners are relative to the middle, in units, at most
  /// kFarthestUnit. Real-time: never from the servo thread.
  void set(std::size_t lane, const std::array<Eigen::Vector3d, 3>& corners) noexcept;
};

/// A segment in units, without its begin.
struct SegmentInUnits {
  std::array<float, 3> way;  ///< From its begin to its end.
  float way_size;            ///< Largest part of `way`.
  float way_wrong;           ///< Error of parts of `way`, in addition to their rounding.
  float wrong;               ///< Error of corners relative to its begin.
};

/// Converts the way of a segment to units, with `per_step` units per step. `rounding` is the
/// maximum difference of its numbers from those that decide crossings. Both are in steps of a
/// SearchFrame. Real-time: safe.
SegmentInUnits segment_in_units(const Eigen::Vector3d& way, double rounding,
                                double per_step) noexcept;

/// The closest point known so far in units, relative to the query point.
struct NearestInUnits {
  std::array<float, 3> to;  ///< To the closest point.
  float size;               ///< Sum of its parts without their signs.
  float squared;            ///< Squared distance beyond which triangles are not wanted.
  float wrong;              ///< Error of corners relative to the query point.
};

/// Converts the closest point known so far to units, with `per_step` units per step of a
/// SearchFrame. `rounding` is the maximum difference of corners from those that give distances, in
/// steps. Real-time: safe.
NearestInUnits nearest_in_units(const NearestSoFar& best, double rounding,
                                double per_step) noexcept;

/// Returns bit i for each lane whose triangle may be as near to `from` (relative to the middle, in
/// units) as the closest point known. Triangles are dropped only with certainty: all their corners
/// are beyond the plane across the way to that point. Lanes without a triangle may be set.
/// Real-time: safe.
unsigned nearer_of_eight(const NearestInUnits& nearest, const Eigen::Vector3d& from,
                         const EightTriangles& eight) noexcept;

/// Returns bit i for each lane whose triangle a segment from `from` (relative to the middle, in
/// units) may cross. Triangles are dropped only with certainty: the segment's line misses them, or
/// both of its ends are on one side. Lanes without a triangle may be set. Real-time: safe; about 15
/// ns.
unsigned met_of_eight(const SegmentInUnits& segment, const Eigen::Vector3d& from,
                      const EightTriangles& eight) noexcept;

}  // namespace thimble::render
