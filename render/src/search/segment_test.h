#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "compact_mesh/packed_surface.h"
#include "mesh/segment_crossing.h"
#include "search/contact_search.h"

namespace thimble::render {

/// Returns the largest absolute component of a vector. Real-time: safe.
inline double largest(const Eigen::Vector3d& v) noexcept {
  return std::max(std::max(std::abs(v.x()), std::abs(v.y())), std::abs(v.z()));
}

/// Decides how one segment passes the packed triangles of a surface: in double precision on the
/// lattice where that is certain, else by `crossing`. Real-time: safe; about 10 ns where it is
/// certain.
class SegmentTest {
 public:
  /// Precondition: both points (W, m) are `within_range`, and outlive the test.
  SegmentTest(const PackedSurface& surface, const Eigen::Vector3d& p_from,
              const Eigen::Vector3d& p_to) noexcept
      : surface_(surface),
        p_from_(p_from),
        p_to_(p_to),
        from_(surface.to_lattice(p_from)),
        way_(surface.to_lattice(p_to) - from_),
        way_size_(largest(way_)) {
    // `crossing` uses positions in W, rounded at the size of their coordinates.
    const double size =
        std::max(std::max(largest(p_from), largest(p_to)), largest(surface.origin()));
    position_rounding_ = 0x1p-50 * (size * surface.per_step() + kLatticeHalf);
  }

  /// Returns how the segment crosses packed triangle `t`, and where (0 at its begin, 1 at its end).
  Crossing cross(std::int32_t t, double& parameter) const noexcept;

  const PackedSurface& surface() const noexcept { return surface_; }  ///< Returns the surface.
  /// Returns the segment in steps of the lattice.
  const Eigen::Vector3d& from() const noexcept { return from_; }
  const Eigen::Vector3d& way() const noexcept { return way_; }
  double way_size() const noexcept {
    return way_size_;
  }  ///< Returns the largest absolute
     ///< component of the path.

  /// Returns the box around the segment in steps of the lattice, with a margin for rounding.
  Eigen::Vector3d low() const noexcept {
    return from_.cwiseMin(from_ + way_) - Eigen::Vector3d::Constant(room());
  }
  Eigen::Vector3d high() const noexcept {
    return from_.cwiseMax(from_ + way_) + Eigen::Vector3d::Constant(room());
  }
  /// Returns the margin around that box, in steps.
  double room() const noexcept { return 2 + 4 * position_rounding_; }
  /// Returns the maximum difference of these numbers from those used by `crossing`, in steps.
  double position_rounding() const noexcept { return position_rounding_; }

 private:
  const PackedSurface& surface_;
  const Eigen::Vector3d& p_from_;
  const Eigen::Vector3d& p_to_;
  Eigen::Vector3d from_, way_;
  double way_size_;
  double position_rounding_;
};

/// Numbers of a segment that quickly prove that it does not cross a packed triangle, in steps.
struct SegmentBounds {
  std::array<std::int32_t, 4> low, high;  ///< Its box, with a margin for rounding; three lanes are
                                          ///< used.
  std::array<std::int32_t, 4> from;       ///< Its begin, rounded.
  std::array<float, 3> way;
  float way_size;    ///< Largest absolute component of `way`.
  float from_wrong;  ///< Maximum difference of `from` from the true begin.
  bool single;       ///< Whether single precision is usable.
};

/// Drops packed triangles that a segment does not cross. Real-time: safe.
class SegmentSieve {
 public:
  explicit SegmentSieve(const SegmentTest& segment) noexcept;

  /// Writes the packed triangles of a list that the segment may cross to `near`, and returns their
  /// number. Triangles are dropped only with certainty: by boxes, and by the sides on which the
  /// segment passes the edges, in single precision. Precondition: `near` has room for the whole
  /// list.
  std::size_t select_near(std::span<const std::int32_t> list, std::int32_t* near) const noexcept;

 private:
  const PackedTriangle* triangles_;
  SegmentBounds bounds_;
};

/// Limits the parameter of a crossing to the part of the segment in the box of the triangle a, b,
/// c, given relative to the segment's begin. Where the two are nearly parallel, the parameter is
/// rounding. The limit ensures that a triangle whose box begins later is never crossed earlier.
/// Real-time: safe.
double kept_in_box(double parameter, const Eigen::Vector3d& way, const Eigen::Vector3d& a,
                   const Eigen::Vector3d& b, const Eigen::Vector3d& c) noexcept;

/// Margin around boxes, in steps, for the rounding of a segment within the lattice. Covers several
/// times the rounding of its begin, of the way to a node, of that divided by its own way, and of
/// the sum with a side (at most 2^-24 of 2^31 steps each).
inline constexpr float kBoxRoom = 2048;

/// A segment cut to the part that can reach a surface, in steps of the lattice and single
/// precision.
struct ReachedPart {
  bool any = false;
  Eigen::Vector3f from, way;
  double begin = 0, length = 0;  ///< Of the part, as parameters of the segment.
  float room = kBoxRoom;         ///< Margin around boxes, for this rounding and that of far ends.
};

/// Cuts a segment to the cube of the lattice. Real-time: safe.
ReachedPart reached_part(const Eigen::Vector3d& from, const Eigen::Vector3d& way) noexcept;

}  // namespace thimble::render
