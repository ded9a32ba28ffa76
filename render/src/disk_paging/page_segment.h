#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "disk_paging/page_file.h"
#include "mesh/segment_crossing.h"

namespace thimble::render {

/// A segment tested against the packed triangles of a page file. Boxes and planes drop triangles
/// out of reach in a few ns; `crossing` decides the rest without rounding. Real-time: safe.
class PageSegment {
 public:
  /// Takes the ends of the segment (W, m).
  PageSegment(const Lattice& lattice, const Eigen::Vector3d& p_from,
              const Eigen::Vector3d& p_to) noexcept
      : lattice_(lattice),
        p_from_(p_from),
        p_to_(p_to),
        from_((p_from - lattice.origin) / lattice.step),
        to_((p_to - lattice.origin) / lattice.step) {
    // Covers the rounding of these divisions and of Lattice::position, a few times, plus two steps
    // for that of the boxes.
    const double size = std::max({lattice.origin.cwiseAbs().maxCoeff(),
                                  p_from.cwiseAbs().maxCoeff(), p_to.cwiseAbs().maxCoeff()});
    rounding_ = 1 + size * 0x1p-50 / lattice.step;
    low = from_.cwiseMin(to_) - Eigen::Vector3d::Constant(1 + rounding_);
    high = from_.cwiseMax(to_) + Eigen::Vector3d::Constant(1 + rounding_);
    way_ = to_ - from_;
    half_way_ = 0.5 * way_.cwiseAbs();
  }

  /// Returns whether the segment may reach a box: false only if a plane of the box, or one through
  /// an edge of it and the segment, separates them. False for NaN.
  bool reaches(const PageBox& box) const noexcept {
    if (!render::reaches(box, low, high)) return false;
    Eigen::Vector3d half, apart;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto i = static_cast<Eigen::Index>(axis);
      const double a = double{box.min[axis]} - rounding_, b = double{box.max[axis]} + rounding_;
      half[i] = 0.5 * (b - a);
      apart[i] = 0.5 * (from_[i] + to_[i]) - 0.5 * (a + b);
    }
    const Eigen::Vector3d across = apart.cross(way_);
    const Eigen::Vector3d w = 2 * half_way_;
    const Eigen::Vector3d room(half.y() * w.z() + half.z() * w.y(),
                               half.x() * w.z() + half.z() * w.x(),
                               half.x() * w.y() + half.y() * w.x());
    // A larger margin for the rounding of the products.
    return std::abs(across.x()) <= room.x() * kMore && std::abs(across.y()) <= room.y() * kMore &&
           std::abs(across.z()) <= room.z() * kMore;
  }

  /// Returns how the segment crosses a packed triangle, and where: 0 at its begin, 1 at its end.
  Crossing cross(const PackedTriangle& packed, double& parameter) const noexcept {
    if (!near(packed.x, 0) || !near(packed.y, 1) || !near(packed.z, 2)) return Crossing::kNone;
    const Eigen::Vector3d a = packed.corner(0);
    const Eigen::Vector3d n = (packed.corner(1) - a).cross(packed.corner(2) - a);
    const double above = n.dot(from_ - a), below = n.dot(a - to_);
    // Both ends are far enough on one side of the plane. Written such that a triangle without area
    // continues to the exact test.
    const double doubt = (rounding_ + 1e-6) * (std::abs(n.x()) + std::abs(n.y()) + std::abs(n.z()));
    if ((above > doubt && below < -doubt) || (above < -doubt && below > doubt)) {
      return Crossing::kNone;
    }
    const Crossing way = crossing(p_from_, p_to_, lattice_.position(packed, 0),
                                  lattice_.position(packed, 1), lattice_.position(packed, 2));
    if (way == Crossing::kNone) return way;
    const double steep = -n.dot(way_);
    const bool with = way == Crossing::kEnters ? steep > 0 : steep < 0;
    parameter = with ? std::clamp(above / steep, 0.0, 1.0) : 0.0;
    return way;
  }

  Eigen::Vector3d low, high;  ///< Box around the segment, with a margin for rounding, in steps.

 private:
  static constexpr double kMore = 1 + 1e-9;

  bool near(const std::array<std::int32_t, 3>& x, std::size_t axis) const noexcept {
    const auto i = static_cast<Eigen::Index>(axis);
    const auto [least, most] = std::minmax({x[0], x[1], x[2]});
    return most >= low[i] && least <= high[i];
  }

  Lattice lattice_;
  Eigen::Vector3d p_from_, p_to_;
  Eigen::Vector3d from_, to_, way_, half_way_;
  double rounding_ = 0;
};

}  // namespace thimble::render
