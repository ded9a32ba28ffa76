#include "thimble/render/contact/bvh.h"

#include <emmintrin.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "contact/record_tests.h"
#include "thimble/render/contact/closest_point.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr std::uint32_t kLeaf = 0x80000000u;
constexpr std::size_t kLeafMax = 4;

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

float rounded_down(std::int32_t v) noexcept {
  const auto f = static_cast<float>(v);
  return static_cast<double>(f) > v ? std::nextafter(f, -INFINITY) : f;
}

float rounded_up(std::int32_t v) noexcept {
  const auto f = static_cast<float>(v);
  return static_cast<double>(f) < v ? std::nextafter(f, INFINITY) : f;
}

std::int32_t first_record(std::uint32_t leaf) noexcept {
  return static_cast<std::int32_t>((leaf & ~kLeaf) >> 2);
}

std::int32_t end_record(std::uint32_t leaf) noexcept {
  return first_record(leaf) + static_cast<std::int32_t>(leaf & 3u) + 1;
}

}  // namespace

struct Bvh::Box {
  static constexpr std::int32_t kLowest = std::numeric_limits<std::int32_t>::min();
  static constexpr std::int32_t kHighest = std::numeric_limits<std::int32_t>::max();
  std::array<std::int32_t, 3> min{kHighest, kHighest, kHighest};
  std::array<std::int32_t, 3> max{kLowest, kLowest, kLowest};

  void add(std::size_t axis, std::int32_t low, std::int32_t high) noexcept {
    min[axis] = std::min(min[axis], low);
    max[axis] = std::max(max[axis], high);
  }
  void add(const Box& box) noexcept {
    for (std::size_t axis = 0; axis < 3; ++axis) add(axis, box.min[axis], box.max[axis]);
  }
  void add(const CompactTriangle& r) noexcept {
    for (std::size_t k = 0; k < 3; ++k) {
      add(0, r.x[k], r.x[k]);
      add(1, r.y[k], r.y[k]);
      add(2, r.z[k], r.z[k]);
    }
  }
};

Bvh::Bvh(const CompactSurface& surface) : surface_(&surface) {
  const auto records = surface.records();
  std::vector<std::uint64_t> keys(records.size());
  for (std::size_t t = 0; t < records.size(); ++t) keys[t] = morton_key(records[t]);
  // Leaves hold 2.5 records in the mean and nodes 3 of their children.
  nodes_.reserve(records.size() / 6 + 16);
  nodes_.emplace_back();
  build_node(keys, {0, records.size()}, 0);
  nodes_.shrink_to_fit();
}

// Cuts a range where the highest bit changes in which its keys differ: in the middle of space along
// one axis. Equal keys are cut in half.
Bvh::Range Bvh::split(const std::vector<std::uint64_t>& keys, Range range, Range& second) const {
  const std::uint64_t difference = keys[range.begin] ^ keys[range.end - 1];
  std::size_t middle = (range.begin + range.end) / 2;
  if (difference != 0) {
    const std::uint64_t bit = std::bit_floor(difference);
    const auto at = [&keys](std::size_t i) {
      return keys.begin() + static_cast<std::ptrdiff_t>(i);
    };
    const auto place = std::partition_point(at(range.begin), at(range.end),
                                            [bit](std::uint64_t key) { return !(key & bit); });
    middle = static_cast<std::size_t>(place - keys.begin());
  }
  second = {middle, range.end};
  return {range.begin, middle};
}

Bvh::Box Bvh::build_node(const std::vector<std::uint64_t>& keys, Range range, std::uint32_t node) {
  std::array<Range, 4> parts;
  std::size_t count = 1;
  parts[0] = range;
  while (count < 4) {
    const auto largest = std::max_element(
        parts.begin(), parts.begin() + count,
        [](const Range& a, const Range& b) { return a.end - a.begin < b.end - b.begin; });
    if (largest->end - largest->begin <= kLeafMax) break;
    *largest = split(keys, *largest, parts[count]);
    ++count;
  }
  // Siblings stand together: a query that enters one often enters the next.
  std::array<std::uint32_t, 4> children{};
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t size = parts[i].end - parts[i].begin;
    if (size <= kLeafMax) {
      children[i] = kLeaf | static_cast<std::uint32_t>(parts[i].begin << 2) |
                    static_cast<std::uint32_t>(size - 1);
    } else {
      children[i] = static_cast<std::uint32_t>(nodes_.size());
      nodes_.emplace_back();
    }
  }
  Box whole;
  for (std::size_t i = 0; i < 4; ++i) {
    Box box;
    if (i < count && (children[i] & kLeaf) != 0) {
      for (std::size_t t = parts[i].begin; t < parts[i].end; ++t) box.add(surface_->records()[t]);
    } else if (i < count) {
      // May move the nodes: no reference to one is held.
      box = build_node(keys, parts[i], children[i]);
    }
    Node& n = nodes_[node];
    if (i >= count) {
      // No segment and no ball reaches it.
      for (auto* side : {&n.min_x, &n.min_y, &n.min_z}) (*side)[i] = INFINITY;
      for (auto* side : {&n.max_x, &n.max_y, &n.max_z}) (*side)[i] = -INFINITY;
      continue;
    }
    n.min_x[i] = rounded_down(box.min[0]);
    n.min_y[i] = rounded_down(box.min[1]);
    n.min_z[i] = rounded_down(box.min[2]);
    n.max_x[i] = rounded_up(box.max[0]);
    n.max_y[i] = rounded_up(box.max[1]);
    n.max_z[i] = rounded_up(box.max[2]);
    n.children[i] = children[i];
    whole.add(box);
  }
  return whole;
}

// Calls visit(record) for all records near the segment; it returns the parameter beyond which no
// more are wanted.
template <class Visit>
void Bvh::visit_reached(const Vector3d& from, const Vector3d& way, Visit visit) const noexcept {
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
    const float room = r < 0 ? -kBoxRoom : kBoxRoom;
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
      for (std::int32_t t = first_record(next.child); t < end_record(next.child); ++t) {
        const double wanted = (visit(t) - part.begin) / part.length;
        limit = std::min(limit, static_cast<float>(wanted) + 1e-5f);
      }
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

Entry Bvh::first_entry(const Vector3d& p_from, const Vector3d& p_to) const noexcept {
  Entry first;
  if (!within_range(p_from) || !within_range(p_to)) return first;
  const SegmentTest segment(*surface_, p_from, p_to);
  double limit = 2;
  visit_reached(segment.from(), segment.way(), [&](std::int32_t t) noexcept {
    double parameter = 0;
    if (segment.near(t) && segment.cross(t, parameter) == Crossing::kEnters && parameter < limit) {
      first = {t, parameter};
      limit = parameter;
    }
    return limit;
  });
  return first;
}

bool Bvh::inside(const Vector3d& p_W) const noexcept {
  if (!within_range(p_W)) return false;
  const Vector3d at = surface_->to_lattice(p_W);
  // Written so that NaN is outside; one step of room for the rounding of the middle.
  if (!(at.cwiseAbs().maxCoeff() <= kLatticeHalf + 1)) return false;
  Vector3d p_far = p_W;
  p_far.x() = surface_->origin().x() + 4 * kLatticeHalf * surface_->step();
  const SegmentTest segment(*surface_, p_W, p_far);
  unsigned crossings = 0;
  visit_reached(segment.from(), segment.way(), [&](std::int32_t t) noexcept {
    double parameter = 0;
    crossings += segment.near(t) && segment.cross(t, parameter) != Crossing::kNone;
    return 2.0;
  });
  return crossings % 2 == 1;
}

SurfacePoint Bvh::closest(const Vector3d& p_W, double radius) const noexcept {
  SurfacePoint best;
  if (!within_range(p_W) || !(radius >= 0)) return best;
  const Vector3d p = surface_->to_lattice(p_W);
  const double reach = std::min(radius / surface_->step(), 1e18);
  double best_squared = reach * reach;
  const auto room = static_cast<float>(0x1p-22 * std::max(p.cwiseAbs().maxCoeff(), kLatticeHalf));
  __m128 above[3], below[3];
  for (int i = 0; i < 3; ++i) {
    above[i] = _mm_set1_ps(static_cast<float>(p[i]) + room);
    below[i] = _mm_set1_ps(static_cast<float>(p[i]) - room);
  }
  constexpr float kSlack = 1e-6f;
  Vector3d nearest{0, 0, 0};
  Stack stack;
  stack.push(0, 0);
  while (!stack.empty()) {
    const Waiting next = stack.pop();
    if (!(static_cast<double>(next.near) <= best_squared)) continue;
    if ((next.child & kLeaf) != 0) {
      for (std::int32_t t = first_record(next.child); t < end_record(next.child); ++t) {
        const CompactTriangle& r = surface_->record(t);
        const Vector3d q = closest_point(p, r.corner(0), r.corner(1), r.corner(2));
        const double squared = (q - p).squaredNorm();
        const bool nearer = squared < best_squared;
        const bool first = best.triangle < 0 && squared <= best_squared;
        const bool lower = squared == best_squared && t < best.triangle;
        if (!nearer && !first && !lower) continue;
        best_squared = squared;
        nearest = q;
        best.triangle = t;
      }
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
    const __m128 limit = _mm_set1_ps(static_cast<float>(best_squared) * (1 + kSlack));
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
  if (best.triangle >= 0) {
    best.p_W = surface_->origin() + surface_->step() * nearest;
    best.distance = surface_->step() * std::sqrt(best_squared);
  }
  return best;
}

}  // namespace thimble::render
