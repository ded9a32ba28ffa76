#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "mesh/segment_crossing.h"
#include "search/contact_search.h"
#include "search/nearest_list.h"
#include "search/search_frame.h"

namespace thimble::render {

// Evaluation of the triangles found, shared by all searches, so that their results are the same in
// any order. Real-time: safe.

/// Calls visit(t) for each triangle of a list, of any length, that the segment of a sieve may
/// cross.
template <class Sieve, class Visit>
void visit_near(const Sieve& sieve, std::span<const std::int32_t> list, Visit visit) noexcept {
  constexpr std::size_t kAtOnce = 16;
  std::array<std::int32_t, kAtOnce> near;
  while (!list.empty()) {
    const auto part = list.first(std::min(list.size(), kAtOnce));
    const std::size_t count = sieve.select_near(part, near.data());
    for (std::size_t i = 0; i < count; ++i) visit(near[i]);
    list = list.subspan(part.size());
  }
}

/// Keeps the first entry among the triangles shown to it.
template <class Test>
class FirstEntry {
 public:
  explicit FirstEntry(const Test& segment) noexcept : segment_(segment) {}

  void consider(std::int32_t t) noexcept {
    double parameter = 0;
    if (segment_.cross(t, parameter) != Crossing::kEnters) return;
    if (parameter < limit_ || (parameter == limit_ && t < entry_.triangle)) {
      entry_ = {t, parameter};
      limit_ = parameter;
    }
  }

  const Entry& entry() const noexcept { return entry_; }
  /// Returns the parameter beyond which triangles are not wanted.
  double limit() const noexcept { return limit_; }

 private:
  const Test& segment_;
  Entry entry_;
  double limit_ = 2;
};

/// Returns the number of triangles of a list that a segment crosses.
template <class Test, class Sieve>
unsigned count_crossings(const Test& segment, const Sieve& sieve,
                         std::span<const std::int32_t> list) noexcept {
  unsigned crossings = 0;
  visit_near(sieve, list, [&](std::int32_t t) noexcept {
    double parameter = 0;
    crossings += segment.cross(t, parameter) != Crossing::kNone;
  });
  return crossings;
}

/// Keeps the closest point among the triangles shown to it. `p` and the reach are in steps.
template <class Surface>
class NearestPoint {
 public:
  NearestPoint(const Surface& surface, const SearchFrame& frame, const Eigen::Vector3d& p,
               double reach) noexcept
      : surface_(surface), frame_(frame), p_(p), best_{.squared = reach * reach} {}

  void consider(std::span<const std::int32_t> list) noexcept {
    render::consider(surface_, frame_, list, p_, best_);
  }

  bool found() const noexcept { return best_.triangle >= 0; }
  /// Returns the squared distance beyond which triangles are not wanted.
  double squared() const noexcept { return best_.squared; }
  NearestSoFar& so_far() noexcept { return best_; }

  SurfacePoint point() const noexcept {
    SurfacePoint point;
    if (best_.triangle < 0) return point;
    point.triangle = best_.triangle;
    point.distance = frame_.step * std::sqrt(best_.squared);
    point.p_W = frame_.origin + frame_.step * (p_ + best_.to);
    return point;
  }

 private:
  const Surface& surface_;
  const SearchFrame& frame_;
  const Eigen::Vector3d p_;
  NearestSoFar best_;
};

/// Converts a radius (m) to steps, bounded so that its square is a finite float.
inline double reach_of(const SearchFrame& frame, double radius) noexcept {
  return std::min(radius * frame.per_step, 1e18);
}

/// Returns the end of the ray that leaves the surface from `p_W` along x. It is along an axis, so
/// that boxes drop all other triangles.
inline Eigen::Vector3d far_along_x(const SearchFrame& frame, const Eigen::Vector3d& p_W) noexcept {
  return {frame.origin.x() + 4 * kLatticeHalf * frame.step, p_W.y(), p_W.z()};
}

/// Returns whether a point (steps) can be inside at all; false for NaN. One step of margin covers
/// the rounding of the frame's middle.
inline bool in_frame(const Eigen::Vector3d& p) noexcept {
  // Eigen's maximum does not detect NaN.
  return (p.array().abs() <= kLatticeHalf + 1).all();
}

}  // namespace thimble::render
