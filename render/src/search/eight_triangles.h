#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>

#include "search/nearest_so_far.h"

namespace thimble::render {

/// Corners of up to eight triangles side by side, as seen from the middle of a volume and rounded
/// to a unit: what a segment is asked against eight at a time, to drop those that it does not cross
/// before any of them is read.
struct alignas(16) EightTriangles {
  static constexpr std::size_t kMost = 8;         ///< Triangles.
  static constexpr double kFarthestUnit = 32700;  ///< Of a corner from the middle, in units.
  using Lanes = std::array<std::int16_t, kMost>;
  std::array<Lanes, 3> x{}, y{}, z{};  ///< Of corner k, one triangle per lane.

  /// Puts a triangle into a lane; corners are seen from the middle, in units, at most
  /// kFarthestUnit. Real-time: never from the servo thread.
  void set(std::size_t lane, const std::array<Eigen::Vector3d, 3>& corners) noexcept;
};

/// A segment in units, but for where it begins.
struct SegmentInUnits {
  std::array<float, 3> way;  ///< From its begin to its end.
  float way_size;            ///< Largest part of `way`.
  float way_wrong;           ///< How far parts of `way` may be off, beside their rounding.
  float wrong;               ///< Likewise corners as seen from its begin.
};

/// Turns the way of a segment into units of `per_step` to a step. `rounding` is how far its numbers
/// may be from those that crossings are decided by; both in steps of a SearchFrame. Real-time:
/// safe.
SegmentInUnits segment_in_units(const Eigen::Vector3d& way, double rounding,
                                double per_step) noexcept;

/// The nearest point known so far in units, as seen from the point that is asked about.
struct NearestInUnits {
  std::array<float, 3> to;  ///< To the nearest point.
  float size;               ///< Sum of its parts without their signs.
  float squared;            ///< Squared distance beyond which no more triangles are wanted.
  float wrong;              ///< How far corners as seen from the point may be off.
};

/// Turns the nearest point known so far into units of `per_step` to a step of a SearchFrame;
/// `rounding` is how far corners may be from those that distances are computed from, in steps.
/// Real-time: safe.
NearestInUnits nearest_in_units(const NearestSoFar& best, double rounding,
                                double per_step) noexcept;

/// Returns bit i for each lane whose triangle may be as near to `from` (seen from the middle, in
/// units) as the nearest point known; what is left out is certain: all its corners lie beyond the
/// plane across the way to that point. Lanes without a triangle may be set. Real-time: safe.
unsigned nearer_of_eight(const NearestInUnits& nearest, const Eigen::Vector3d& from,
                         const EightTriangles& eight) noexcept;

/// Returns bit i for each lane whose triangle a segment from `from` (seen from the middle, in
/// units) may cross; what is left out is certain: its line passes beside the edges, or both of its
/// ends lie on one side. Lanes without a triangle may be set. Real-time: safe; about 15 ns.
unsigned met_of_eight(const SegmentInUnits& segment, const Eigen::Vector3d& from,
                      const EightTriangles& eight) noexcept;

}  // namespace thimble::render
