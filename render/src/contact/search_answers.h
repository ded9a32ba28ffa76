#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "thimble/render/contact/closest_point.h"
#include "thimble/render/contact/contact_search.h"
#include "thimble/render/contact/search_frame.h"
#include "thimble/render/mesh/segment_crossing.h"

namespace thimble::render {

// What all searches do with the triangles that they come upon, in whatever order, so that their
// answers are the same. Real-time: safe.

/// Keeps the first entry among the triangles shown to it.
template <class Test>
class FirstEntry {
 public:
  explicit FirstEntry(const Test& segment) noexcept : segment_(segment) {}

  void consider(std::int32_t t) noexcept {
    if (!segment_.near(t)) return;
    double parameter = 0;
    if (segment_.cross(t, parameter) != Crossing::kEnters) return;
    if (parameter < limit_ || (parameter == limit_ && t < entry_.triangle)) {
      entry_ = {t, parameter};
      limit_ = parameter;
    }
  }

  const Entry& entry() const noexcept { return entry_; }
  /// Tells the parameter beyond which no more triangles are wanted.
  double limit() const noexcept { return limit_; }

 private:
  const Test& segment_;
  Entry entry_;
  double limit_ = 2;
};

/// Keeps the nearest point among the triangles shown to it. `p` and the reach are in steps.
template <class Surface>
class NearestPoint {
 public:
  NearestPoint(const Surface& surface, const SearchFrame& frame, const Eigen::Vector3d& p,
               double reach) noexcept
      : surface_(surface), frame_(frame), p_(p), squared_(reach * reach) {}

  void consider(std::int32_t t) noexcept {
    const Eigen::Vector3d q =
        closest_point(p_, corner_in(frame_, surface_, t, 0), corner_in(frame_, surface_, t, 1),
                      corner_in(frame_, surface_, t, 2));
    const double squared = (q - p_).squaredNorm();
    // Written so that NaN is not nearer.
    const bool nearer = squared < squared_;
    const bool tied = squared == squared_ && (triangle_ < 0 || t < triangle_);
    if (!nearer && !tied) return;
    squared_ = squared;
    nearest_ = q;
    triangle_ = t;
  }

  bool found() const noexcept { return triangle_ >= 0; }
  /// Tells the squared distance beyond which no more triangles are wanted.
  double squared() const noexcept { return squared_; }

  SurfacePoint point() const noexcept {
    SurfacePoint point;
    if (triangle_ < 0) return point;
    point.triangle = triangle_;
    point.distance = frame_.step * std::sqrt(squared_);
    point.p_W = frame_.origin + frame_.step * nearest_;
    return point;
  }

 private:
  const Surface& surface_;
  const SearchFrame& frame_;
  const Eigen::Vector3d p_;
  Eigen::Vector3d nearest_{0, 0, 0};
  std::int32_t triangle_ = -1;
  double squared_;
};

/// Turns a radius (m) into steps, finite also where the radius is not.
inline double reach_of(const SearchFrame& frame, double radius) noexcept {
  return std::min(radius * frame.per_step, 1e18);
}

/// Tells where the ray ends that leaves the surface from `p_W` along x; along an axis, so that
/// boxes drop all but the triangles in the way.
inline Eigen::Vector3d far_along_x(const SearchFrame& frame, const Eigen::Vector3d& p_W) noexcept {
  return {frame.origin.x() + 4 * kLatticeHalf * frame.step, p_W.y(), p_W.z()};
}

/// Tells whether a point (steps) can lie inside at all; NaN cannot. One step of room covers the
/// rounding of the frame's middle.
inline bool in_frame(const Eigen::Vector3d& p) noexcept {
  return p.cwiseAbs().maxCoeff() <= kLatticeHalf + 1;
}

}  // namespace thimble::render
