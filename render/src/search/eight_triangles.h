#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>

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

/// What is known of the point of a surface that is closest to a query point; in units.
struct NearestInUnits {
  std::array<float, 3> to{};  ///< From the query point towards the surface.
  float size = 0;             ///< Sum of its parts without their signs.
  float beyond = 0;           ///< Its length times `far`.
  float far = 0;              ///< Maximum distance of the closest point.
  float wrong = 0;            ///< Error of corners relative to the query point.
};

/// Returns that the closest point is at most `farthest` away, with `per_unit` units per step of a
/// SearchFrame. `rounding` is the maximum difference of corners from those that give distances.
/// Both are in steps. Real-time: safe.
NearestInUnits nearest_in_units(double farthest, double rounding, double per_step) noexcept;

/// Returns bit i for each lane whose triangle may be as near to `from` (relative to the middle, in
/// units) as the closest point. Triangles are dropped only with certainty: all their corners are
/// beyond the plane across `to` at the distance `far`. Lanes without a triangle may be set.
/// Precondition: `measure_eight` has found a nearer point. Real-time: safe; about 10 ns.
unsigned nearer_of_eight(const NearestInUnits& nearest, const Eigen::Vector3d& from,
                         const EightTriangles& eight) noexcept;

/// Measures the distances of the triangles in the lanes `there` from `from` (relative to the
/// middle, in units). Lowers `nearest` if one of them is nearer, and writes to `low` a distance
/// that each triangle is surely not nearer than. Returns bit i for each of these lanes whose
/// triangle may have the closest point. `low` has eight elements aligned to 32 bytes. Real-time:
/// safe; about 30 ns.
unsigned measure_eight(NearestInUnits& nearest, const Eigen::Vector3d& from,
                       const EightTriangles& eight, unsigned there, float* low) noexcept;

/// Returns bit i for each lane whose triangle a segment from `from` (relative to the middle, in
/// units) may cross. Triangles are dropped only with certainty: the segment's line misses them, or
/// both of its ends are on one side. Lanes without a triangle may be set. Real-time: safe; about 15
/// ns.
unsigned met_of_eight(const SegmentInUnits& segment, const Eigen::Vector3d& from,
                      const EightTriangles& eight) noexcept;

}  // namespace thimble::render
