#include "thimble/render/contact/bvh.h"

#include <emmintrin.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "contact/bvh_leaf.h"
#include "contact/mesh_segment_test.h"
#include "contact/search_answers.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

// A path from the root passes at most 48 splits of a key and 28 of equal keys, and leaves three
// others waiting at each.
constexpr std::size_t kStackMax = 3 * (48 + 28) + 4;

struct Waiting {
  std::uint32_t child;
  float near;  // parameter of the segment, or squared distance in steps
};

// Keeps what a query still has to look at.
class Stack {
 public:
  void push(std::uint32_t child, float near) noexcept {
    if (size_ < kStackMax) items_[size_++] = {child, near};
  }
  bool empty() const noexcept { return size_ == 0; }
  Waiting pop() noexcept { return items_[--size_]; }

  // Puts the nearest of those pushed since `base` on top.
  void raise_nearest(std::size_t base) noexcept {
    for (std::size_t i = base; i + 1 < size_; ++i) {
      if (items_[i].near < items_[size_ - 1].near) std::swap(items_[i], items_[size_ - 1]);
    }
  }
  std::size_t size() const noexcept { return size_; }

 private:
  std::array<Waiting, kStackMax> items_;
  std::size_t size_ = 0;
};

}  // namespace

template <class Surface>
auto TreeSearch<Surface>::leaf_at(std::uint32_t child) const noexcept -> Leaf {
  Leaf leaf;
  const std::size_t begin = first_place(child);
  leaf.size = end_place(child) - begin;
  for (std::size_t i = 0; i < leaf.size; ++i) leaf.triangles[i] = triangle_at(begin + i);
  return leaf;
}

// Calls visit(list) for all leaves near the segment; it returns the parameter beyond which
// no more are wanted.
template <class Surface>
template <class Visit>
void TreeSearch<Surface>::visit_reached(const Vector3d& from, const Vector3d& way,
                                        Visit visit) const noexcept {
  const ReachedPart part = reached_part(from, way);
  if (!part.any) return;
  // Less than this share of a step makes no difference to the room around the boxes, and keeps
  // products with the reciprocal finite.
  const auto reciprocal = [](float v) noexcept {
    constexpr float kLeast = 1e-20f;
    return 1 / std::copysign(std::max(std::abs(v), kLeast), v);
  };
  __m128 near_side[3], far_side[3], scale[3];
  std::array<bool, 3> backwards;
  for (int i = 0; i < 3; ++i) {
    const auto axis = static_cast<std::size_t>(i);
    const float r = reciprocal(part.way[i]);
    backwards[axis] = r < 0;
    const float room = r < 0 ? -part.room : part.room;
    near_side[axis] = _mm_set1_ps(part.from[i] + room);
    far_side[axis] = _mm_set1_ps(part.from[i] - room);
    scale[axis] = _mm_set1_ps(r);
  }
  // Covers the rounding of a difference and a product, several times.
  constexpr float kSlack = 1e-6f;
  float limit = 1 + kSlack;
  Stack stack;
  stack.push(0, 0);
  while (!stack.empty()) {
    const Waiting next = stack.pop();
    if (!(next.near <= limit)) continue;
    if ((next.child & kLeaf) != 0) {
      const Leaf leaf = leaf_at(next.child);
      const double wanted = (visit(leaf.list()) - part.begin) / part.length;
      limit = std::min(limit, static_cast<float>(wanted) + 1e-5f);
      continue;
    }
    const Node& n = nodes_[next.child];
    const auto along = [&](std::size_t axis, const float* low, const float* high, __m128& begin,
                           __m128& end) noexcept {
      const __m128 near = _mm_load_ps(backwards[axis] ? high : low);
      const __m128 far = _mm_load_ps(backwards[axis] ? low : high);
      begin = _mm_max_ps(_mm_mul_ps(_mm_sub_ps(near, near_side[axis]), scale[axis]), begin);
      end = _mm_min_ps(_mm_mul_ps(_mm_sub_ps(far, far_side[axis]), scale[axis]), end);
    };
    __m128 begin = _mm_setzero_ps();
    __m128 end = _mm_set1_ps(limit);
    along(0, n.min_x.data(), n.max_x.data(), begin, end);
    along(1, n.min_y.data(), n.max_y.data(), begin, end);
    along(2, n.min_z.data(), n.max_z.data(), begin, end);
    begin = _mm_mul_ps(begin, _mm_set1_ps(1 - kSlack));
    end = _mm_mul_ps(end, _mm_set1_ps(1 + kSlack));
    auto hits = static_cast<unsigned>(_mm_movemask_ps(_mm_cmple_ps(begin, end)));
    alignas(16) std::array<float, 4> nears;
    _mm_store_ps(nears.data(), begin);
    const std::size_t base = stack.size();
    for (; hits != 0; hits &= hits - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(hits));
      stack.push(n.children[i], nears[i]);
    }
    stack.raise_nearest(base);
  }
}

template <class Surface>
Entry TreeSearch<Surface>::first_entry(const Vector3d& p_from,
                                       const Vector3d& p_to) const noexcept {
  if (!within_range(p_from) || !within_range(p_to)) return {};
  const auto segment = segment_test(*surface_, frame_, p_from, p_to);
  FirstEntry first(segment);
  visit_reached(segment.from(), segment.way(), [&](std::span<const std::int32_t> list) noexcept {
    first.consider(list);
    return first.limit();
  });
  return first.entry();
}

template <class Surface>
bool TreeSearch<Surface>::inside(const Vector3d& p_W) const noexcept {
  if (!within_range(p_W) || !in_frame(frame_.to_steps(p_W))) return false;
  const Vector3d p_far = far_along_x(frame_, p_W);
  const auto segment = segment_test(*surface_, frame_, p_W, p_far);
  unsigned crossings = 0;
  visit_reached(segment.from(), segment.way(), [&](std::span<const std::int32_t> list) noexcept {
    crossings += count_crossings(segment, list);
    return 2.0;
  });
  return crossings % 2 == 1;
}

template <class Surface>
SurfacePoint TreeSearch<Surface>::closest(const Vector3d& p_W, double radius) const noexcept {
  if (!within_range(p_W) || !(radius >= 0)) return {};
  const Vector3d p = frame_.to_steps(p_W);
  NearestPoint best(*surface_, frame_, p, reach_of(frame_, radius));
  const auto room = static_cast<float>(0x1p-22 * std::max(p.cwiseAbs().maxCoeff(), kLatticeHalf));
  __m128 above[3], below[3];
  for (int i = 0; i < 3; ++i) {
    above[i] = _mm_set1_ps(static_cast<float>(p[i]) + room);
    below[i] = _mm_set1_ps(static_cast<float>(p[i]) - room);
  }
  constexpr float kSlack = 1e-6f;
  Stack stack;
  stack.push(0, 0);
  while (!stack.empty()) {
    const Waiting next = stack.pop();
    if (!(static_cast<double>(next.near) <= best.squared())) continue;
    if ((next.child & kLeaf) != 0) {
      const Leaf leaf = leaf_at(next.child);
      for (const std::int32_t t : leaf.list()) best.consider(t);
      continue;
    }
    const Node& n = nodes_[next.child];
    const auto beyond = [&](std::size_t axis, const float* low, const float* high) noexcept {
      const __m128 under = _mm_sub_ps(_mm_load_ps(low), above[axis]);
      const __m128 over = _mm_sub_ps(below[axis], _mm_load_ps(high));
      const __m128 gap = _mm_max_ps(_mm_max_ps(under, over), _mm_setzero_ps());
      return _mm_mul_ps(gap, gap);
    };
    __m128 squared = _mm_add_ps(_mm_add_ps(beyond(0, n.min_x.data(), n.max_x.data()),
                                           beyond(1, n.min_y.data(), n.max_y.data())),
                                beyond(2, n.min_z.data(), n.max_z.data()));
    squared = _mm_mul_ps(squared, _mm_set1_ps(1 - kSlack));
    const __m128 limit = _mm_set1_ps(static_cast<float>(best.squared()) * (1 + kSlack));
    auto hits = static_cast<unsigned>(_mm_movemask_ps(_mm_cmple_ps(squared, limit)));
    alignas(16) std::array<float, 4> nears;
    _mm_store_ps(nears.data(), squared);
    const std::size_t base = stack.size();
    for (; hits != 0; hits &= hits - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(hits));
      stack.push(n.children[i], nears[i]);
    }
    stack.raise_nearest(base);
  }
  return best.point();
}

template <class Surface>
double TreeSearch<Surface>::clearance(const Vector3d& p_W) const noexcept {
  // A hair of room for the rounding of the distance.
  constexpr double kSurely = 1 - 0x1p-20;
  const double distance = closest(p_W, std::numeric_limits<double>::infinity()).distance;
  return std::isfinite(distance) ? kSurely * distance : 0;
}

template class TreeSearch<ContactMesh>;
template class TreeSearch<CompactSurface>;

}  // namespace thimble::render
