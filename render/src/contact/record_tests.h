#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>

#include "thimble/render/contact/compact_surface.h"
#include "thimble/render/contact/linear_search.h"
#include "thimble/render/mesh/segment_crossing.h"

namespace thimble::render {

/// Tells whether a point may be asked about: no coordinate is NaN or beyond `kPositionMax`.
/// Real-time: safe.
inline bool within_range(const Eigen::Vector3d& p_W) noexcept {
  return std::abs(p_W.x()) <= kPositionMax && std::abs(p_W.y()) <= kPositionMax &&
         std::abs(p_W.z()) <= kPositionMax;
}

/// Decides how one segment passes the records of a surface: in double precision on the lattice
/// where that is beyond doubt, else by `crossing`. Real-time: safe; about 10 ns where there is no
/// doubt.
class SegmentTest {
 public:
  /// Precondition: both points (W, m) are `within_range`.
  SegmentTest(const CompactSurface& surface, const Eigen::Vector3d& p_from,
              const Eigen::Vector3d& p_to) noexcept;

  /// Tells whether the boxes of the segment and of record `t` meet.
  bool near(std::int32_t t) const noexcept {
    const CompactTriangle& r = surface_.record(t);
    return meets(r.x, 0) && meets(r.y, 1) && meets(r.z, 2);
  }

  /// Tells the way in which the segment crosses record `t`, and where (0 at its begin, 1 at its
  /// end).
  Crossing cross(std::int32_t t, double& parameter) const noexcept;

  /// Gives the segment in steps of the lattice.
  const Eigen::Vector3d& from() const noexcept { return from_; }
  const Eigen::Vector3d& way() const noexcept { return way_; }

 private:
  bool meets(const std::array<std::int32_t, 3>& x, std::size_t axis) const noexcept {
    const std::int32_t low = low_[axis], high = high_[axis];
    // Bitwise: one branch per axis.
    const bool above = (x[0] > high) & (x[1] > high) & (x[2] > high);
    const bool below = (x[0] < low) & (x[1] < low) & (x[2] < low);
    return !(above | below);
  }

  const CompactSurface& surface_;
  Eigen::Vector3d p_from_, p_to_;
  Eigen::Vector3d from_, way_;
  double way_size_;
  std::array<std::int32_t, 3> low_, high_;  // around the segment, with room for rounding
  double position_rounding_;
};

/// Is a segment cut to the part that can reach a surface, in steps of the lattice and single
/// precision, with the room that this rounding needs.
struct ReachedPart {
  bool any = false;
  Eigen::Vector3f from, way;
  double begin = 0, length = 0;  ///< Of the part, as parameters of the whole segment.
};

/// Is the room around boxes, in steps, that covers the rounding of `ReachedPart` (2^-24 of 2^31
/// steps, a few times).
inline constexpr float kBoxRoom = 1024;

/// Cuts a segment to the cube of the lattice. Real-time: safe.
ReachedPart reached_part(const Eigen::Vector3d& from, const Eigen::Vector3d& way) noexcept;

}  // namespace thimble::render
