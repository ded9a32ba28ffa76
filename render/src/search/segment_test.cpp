#include "search/segment_test.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "compact_mesh/wide_lanes.h"
#include "search/lanes.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

// Sums of products of three factors as below are wrong by less than 2^-48 of the product of the
// largest factors, and by less than eight times the error of one factor.
constexpr double kRounding = 0x1p-48;
constexpr double kSpread = 16;

// Two coordinates of a vector of three: x and y, or z and 0.
__m128d half_of(const double* v, std::size_t half) noexcept {
  return half == 0 ? _mm_loadu_pd(v) : _mm_load_sd(v + 2);
}

// Stores two numbers, cut to integers. All beyond the lattice are equivalent. The upper limit is
// not 2^31 - 1, which SIMDe's conversion changes to -2^31 (sse2_test).
void store_whole(__m128d u, std::size_t half, std::array<std::int32_t, 4>& to) noexcept {
  const __m128d most = _mm_set1_pd(2 * kLatticeHalf - 2), least = _mm_set1_pd(-2 * kLatticeHalf);
  const __m128i whole = _mm_cvttpd_epi32(_mm_max_pd(_mm_min_pd(u, most), least));
  _mm_storel_epi64(reinterpret_cast<__m128i*>(to.data() + 2 * half), whole);
}

// No branches: the sign is not predictable.
int sign_beyond(double value, double bound) noexcept {
  return static_cast<int>(value > bound) - static_cast<int>(value < -bound);
}

}  // namespace

SegmentSieve::SegmentSieve(const SegmentTest& segment) noexcept
    : triangles_(segment.surface().triangles().data()) {
  const Vector3d &from = segment.from(), &way = segment.way();
  const __m128d room = _mm_set1_pd(segment.room());
  for (std::size_t half = 0; half < 2; ++half) {
    const __m128d begin = half_of(from.data(), half);
    const __m128d end = _mm_add_pd(begin, half_of(way.data(), half));
    store_whole(_mm_sub_pd(_mm_min_pd(begin, end), room), half, bounds_.low);
    store_whole(_mm_add_pd(_mm_max_pd(begin, end), room), half, bounds_.high);
    store_whole(begin, half, bounds_.from);
  }
  bounds_.way = {static_cast<float>(way.x()), static_cast<float>(way.y()),
                 static_cast<float>(way.z())};
  bounds_.way_size = static_cast<float>(segment.way_size());
  bounds_.from_wrong = static_cast<float>(segment.position_rounding() + 1);
  // Differences of corners and begin fit into 32 bits, and triple products into a float.
  bounds_.single = largest(from) < kLatticeHalf && segment.way_size() <= 4 * kLatticeHalf;
}

std::size_t SegmentSieve::select_near(std::span<const std::int32_t> list,
                                      std::int32_t* near) const noexcept {
  return wide_lanes() ? lanes_avx2::select_near(bounds_, triangles_, list, near)
                      : lanes_plain::select_near(bounds_, triangles_, list, near);
}

Crossing SegmentTest::cross(std::int32_t t, double& parameter) const noexcept {
  const PackedTriangle& packed = surface_.triangle(t);
  const Vector3d a = packed.corner(0) - from_;
  const Vector3d b = packed.corner(1) - from_;
  const Vector3d c = packed.corner(2) - from_;
  const double size = std::max(std::max(largest(a), largest(b)), largest(c));
  const double reach = size + way_size_;
  const double bound = kSpread * (position_rounding_ + kRounding * reach) * size * reach;
  const int s0 = sign_beyond(way_.dot(a.cross(b)), bound);
  const int s1 = sign_beyond(way_.dot(b.cross(c)), bound);
  const int s2 = sign_beyond(way_.dot(c.cross(a)), bound);
  const Vector3d n = (b - a).cross(c - a);
  const double above = -n.dot(a);
  const double below = n.dot(a - way_);
  const bool sure = s0 != 0 && s1 != 0 && s2 != 0;
  const int from = sign_beyond(above, 8 * bound);
  const int to = -sign_beyond(below, 8 * bound);
  // Passes two edges on different sides, or ends before the plane: one test for all.
  if (((s0 * s1) | (s1 * s2) | (s2 * s0) | -(from * to)) < 0) return Crossing::kNone;
  Crossing way = from > 0 ? Crossing::kEnters : Crossing::kLeaves;
  if (!sure || from == 0 || to == 0) {
    way = crossing(p_from_, p_to_, surface_.position(t, 0), surface_.position(t, 1),
                   surface_.position(t, 2));
  }
  if (way == Crossing::kNone) return way;
  // Rounding may put either end on the wrong side: such a crossing is at that end.
  const double sign = way == Crossing::kEnters ? 1 : -1;
  parameter = 0;
  if (sign * above > 0) parameter = sign * below > 0 ? above / (above + below) : 1;
  parameter = kept_in_box(parameter, way_, a, b, c);
  return way;
}

double kept_in_box(double parameter, const Vector3d& way, const Vector3d& a, const Vector3d& b,
                   const Vector3d& c) noexcept {
  // The quotient is compared only where products leave doubt: 2^-50 of a product is four times the
  // error of product and quotient.
  constexpr double kDoubt = 0x1p-50;
  bool within = parameter >= 0 && parameter <= 1;
  for (int i = 0; i < 3; ++i) {
    const double at = parameter * way[i], room = kDoubt * std::abs(at);
    const double low = std::min(std::min(a[i], b[i]), c[i]);
    const double high = std::max(std::max(a[i], b[i]), c[i]);
    within &= (at - low > room) & (high - at > room);
  }
  if (within) return parameter;
  double begin = 0, end = 1;
  for (int i = 0; i < 3; ++i) {
    if (way[i] == 0) continue;
    const double one = std::min({a[i], b[i], c[i]}) / way[i];
    const double other = std::max({a[i], b[i], c[i]}) / way[i];
    begin = std::max(begin, std::min(one, other));
    end = std::min(end, std::max(one, other));
  }
  return std::max(begin, std::min(parameter, end));
}

ReachedPart reached_part(const Vector3d& from, const Vector3d& way) noexcept {
  const double size = std::max(largest(from), largest(from + way));
  if (size <= kLatticeHalf) {
    return {.any = true, .from = from.cast<float>(), .way = way.cast<float>(), .length = 1};
  }
  const double half = kLatticeHalf + 0x1p12 + 0x1p-48 * size;
  double begin = 0, end = 1;
  for (int axis = 0; axis < 3; ++axis) {
    if (way[axis] == 0) {
      if (!(std::abs(from[axis]) <= half)) return {};
      continue;
    }
    const double one = (-half - from[axis]) / way[axis];
    const double other = (half - from[axis]) / way[axis];
    begin = std::max(begin, std::min(one, other));
    end = std::min(end, std::max(one, other));
  }
  if (!(begin <= end)) return {};
  ReachedPart part;
  part.any = true;
  part.begin = begin;
  part.length = end - begin;
  part.from = (from + begin * way).cast<float>();
  part.way = (part.length * way).cast<float>();
  part.room = kBoxRoom + static_cast<float>(0x1p-48 * size);
  return part;
}

}  // namespace thimble::render
