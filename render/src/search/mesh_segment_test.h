#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "mesh/contact_mesh.h"
#include "mesh/segment_crossing.h"
#include "search/search_frame.h"
#include "search/segment_test.h"

namespace thimble::render {

/// Decides how one segment passes the triangles of a ContactMesh; like SegmentTest for a
/// PackedSurface. Real-time: safe; tens of ns for a triangle that is near.
class MeshSegmentTest {
 public:
  /// Precondition: both points (W, m) are `within_range`.
  MeshSegmentTest(const ContactMesh& mesh, const SearchFrame& frame, const Eigen::Vector3d& p_from,
                  const Eigen::Vector3d& p_to) noexcept
      : mesh_(mesh),
        frame_(frame),
        p_from_(p_from),
        p_to_(p_to),
        from_(frame.to_steps(p_from)),
        to_(frame.to_steps(p_to)) {}

  /// Returns how the segment crosses triangle `t`, and where (0 at its begin, 1 at its end).
  Crossing cross(std::int32_t t, double& parameter) const noexcept {
    const Crossing way =
        crossing(p_from_, p_to_, mesh_.position(t, 0), mesh_.position(t, 1), mesh_.position(t, 2));
    if (way == Crossing::kNone) return way;
    const double sign = way == Crossing::kEnters ? 1 : -1;
    const double above = -sign * mesh_.depth(t, p_from_);
    const double below = sign * mesh_.depth(t, p_to_);
    // Rounding may put either end on the wrong side: such a crossing is at that end.
    parameter = 0;
    if (above > 0) parameter = below > 0 ? above / (above + below) : 1;
    parameter = kept_in_box(parameter, p_to_ - p_from_, mesh_.position(t, 0) - p_from_,
                            mesh_.position(t, 1) - p_from_, mesh_.position(t, 2) - p_from_);
    return way;
  }

  /// Returns the segment in steps of the frame.
  const Eigen::Vector3d& from() const noexcept { return from_; }
  Eigen::Vector3d way() const noexcept { return to_ - from_; }

  /// Returns the box around the segment in steps of the frame. Needs no margin: conversion to steps
  /// is monotone.
  Eigen::Vector3d low() const noexcept { return from_.cwiseMin(to_); }
  Eigen::Vector3d high() const noexcept { return from_.cwiseMax(to_); }
  /// Returns the maximum difference of these numbers from those used by `crossing`, in steps.
  double position_rounding() const noexcept {
    const double size = std::max({p_from_.cwiseAbs().maxCoeff(), p_to_.cwiseAbs().maxCoeff(),
                                  frame_.origin.cwiseAbs().maxCoeff()});
    return 0x1p-50 * (size * frame_.per_step + kLatticeHalf);
  }

  /// Returns whether the boxes of a triangle and of the segment meet.
  bool meets(std::int32_t t) const noexcept {
    const Eigen::Vector3d& a = mesh_.position(t, 0);
    const Eigen::Vector3d& b = mesh_.position(t, 1);
    const Eigen::Vector3d& c = mesh_.position(t, 2);
    for (int i = 0; i < 3; ++i) {
      if (std::min({a[i], b[i], c[i]}) > std::max(p_from_[i], p_to_[i])) return false;
      if (std::max({a[i], b[i], c[i]}) < std::min(p_from_[i], p_to_[i])) return false;
    }
    return true;
  }

 private:
  const ContactMesh& mesh_;
  const SearchFrame& frame_;
  const Eigen::Vector3d& p_from_;
  const Eigen::Vector3d& p_to_;
  Eigen::Vector3d from_, to_;
};

/// Drops triangles whose boxes do not meet the segment's. Real-time: safe.
class MeshSegmentSieve {
 public:
  explicit MeshSegmentSieve(const MeshSegmentTest& segment) noexcept : segment_(segment) {}

  /// Writes the remaining triangles of a list to `near`, and returns their number. Precondition:
  /// `near` has room for the whole list.
  std::size_t select_near(std::span<const std::int32_t> list, std::int32_t* near) const noexcept {
    std::size_t count = 0;
    for (const std::int32_t t : list) {
      near[count] = t;
      count += segment_.meets(t) ? 1 : 0;
    }
    return count;
  }

 private:
  const MeshSegmentTest& segment_;
};

// Returns the test for a surface, and the sieve for a test.
inline MeshSegmentTest segment_test(const ContactMesh& mesh, const SearchFrame& frame,
                                    const Eigen::Vector3d& p_from,
                                    const Eigen::Vector3d& p_to) noexcept {
  return {mesh, frame, p_from, p_to};
}
inline SegmentTest segment_test(const PackedSurface& surface, const SearchFrame&,
                                const Eigen::Vector3d& p_from,
                                const Eigen::Vector3d& p_to) noexcept {
  return {surface, p_from, p_to};
}
inline MeshSegmentSieve sieve_of(const MeshSegmentTest& segment) noexcept {
  return MeshSegmentSieve(segment);
}
inline SegmentSieve sieve_of(const SegmentTest& segment) noexcept {
  return SegmentSieve(segment);
}

}  // namespace thimble::render
