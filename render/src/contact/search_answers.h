#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "thimble/render/contact/closest_point.h"
#include "thimble/render/contact/contact_search.h"
#include "thimble/render/contact/search_frame.h"
#include "thimble/render/mesh/segment_crossing.h"

namespace thimble::render {

// What all searches do with the triangles that they come upon, in whatever order, so that their
// answers are the same. Real-time: safe.

/// Calls visit(t) for each triangle of a list, of whatever length, that a segment may cross.
template <class Test, class Visit>
void visit_near(const Test& segment, std::span<const std::int32_t> list, Visit visit) noexcept {
  constexpr std::size_t kAtOnce = 16;
  std::array<std::int32_t, kAtOnce> near;
  while (!list.empty()) {
    const auto part = list.first(std::min(list.size(), kAtOnce));
    const std::size_t count = segment.select_near(part, near.data());
    for (std::size_t i = 0; i < count; ++i) visit(near[i]);
    list = list.subspan(part.size());
  }
}

/// Keeps the first entry among the triangles shown to it.
template <class Test>
class FirstEntry {
 public:
  explicit FirstEntry(const Test& segment) noexcept : segment_(segment) {}

  void consider(std::span<const std::int32_t> list) noexcept {
    visit_near(segment_, list, [this](std::int32_t t) noexcept {
      double parameter = 0;
      if (segment_.cross(t, parameter) != Crossing::kEnters) return;
      if (parameter < limit_ || (parameter == limit_ && t < entry_.triangle)) {
        entry_ = {t, parameter};
        limit_ = parameter;
      }
    });
  }

  const Entry& entry() const noexcept { return entry_; }
  /// Tells the parameter beyond which no more triangles are wanted.
  double limit() const noexcept { return limit_; }

 private:
  const Test& segment_;
  Entry entry_;
  double limit_ = 2;
};

/// Counts how many triangles of a list a segment crosses.
template <class Test>
unsigned count_crossings(const Test& segment, std::span<const std::int32_t> list) noexcept {
  unsigned crossings = 0;
  visit_near(segment, list, [&](std::int32_t t) noexcept {
    double parameter = 0;
    crossings += segment.cross(t, parameter) != Crossing::kNone;
  });
  return crossings;
}

/// Keeps the nearest point among the triangles shown to it. `p` and the reach are in steps.
template <class Surface>
class NearestPoint {
 public:
  NearestPoint(const Surface& surface, const SearchFrame& frame, const Eigen::Vector3d& p,
               double reach) noexcept
      : surface_(surface), frame_(frame), p_(p), squared_(reach * reach) {}

  void consider(std::int32_t t) noexcept {
    const Eigen::Vector3d a = corner_in(frame_, surface_, t, 0) - p_;
    const Eigen::Vector3d b = corner_in(frame_, surface_, t, 1) - p_;
    const Eigen::Vector3d c = corner_in(frame_, surface_, t, 2) - p_;
    // All of a triangle lies as far along the way to the nearest point as its corners: beyond the
    // plane there, nothing of it is nearer. Most triangles around are told so by nine products.
    const bool beyond = std::min({a.dot(to_), b.dot(to_), c.dot(to_)}) > squared_;
    if (beyond & (triangle_ >= 0)) return;
    const Eigen::Vector3d to = closest_point(Eigen::Vector3d::Zero(), a, b, c);
    const double squared = to.squaredNorm();
    // Written so that NaN is not nearer.
    const bool nearer = squared < squared_;
    const bool tied = squared == squared_ && (triangle_ < 0 || t < triangle_);
    if (!nearer && !tied) return;
    squared_ = squared;
    to_ = to;
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
    point.p_W = frame_.origin + frame_.step * (p_ + to_);
    return point;
  }

 private:
  const Surface& surface_;
  const SearchFrame& frame_;
  const Eigen::Vector3d p_;
  Eigen::Vector3d to_{0, 0, 0};  // from `p_` to the nearest point
  std::int32_t triangle_ = -1;
  double squared_;
};

/// Turns a radius (m) into steps, at most such that its square is a finite float.
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
