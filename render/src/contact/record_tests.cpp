#include "contact/record_tests.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace thimble::render {
namespace {

using Eigen::Vector3d;

// Sums of products of three factors as below are wrong by less than 2^-48 of the product of the
// largest factors, and by less than eight times what one factor is wrong by.
constexpr double kRounding = 0x1p-48;
constexpr double kSpread = 16;

// The same in single precision, from corners that are exact but for one rounding, and from a begin
// that is wrong by half a step.
constexpr float kSingleRounding = 0x1p-21f;

// Lanes 0 to 2 become those of the next corner.
__m128 next_corner(__m128 u) noexcept {
  return _mm_shuffle_ps(u, u, _MM_SHUFFLE(3, 0, 2, 1));
}

int sign_beyond(double value, double bound) noexcept {
  return value > bound ? 1 : value < -bound ? -1 : 0;
}

}  // namespace

SegmentTest::SegmentTest(const CompactSurface& surface, const Vector3d& p_from,
                         const Vector3d& p_to) noexcept
    : surface_(surface),
      p_from_(p_from),
      p_to_(p_to),
      from_(surface.to_lattice(p_from)),
      way_(surface.to_lattice(p_to) - from_),
      way_size_(way_.cwiseAbs().maxCoeff()) {
  // What `crossing` sees are positions in W, rounded at the size of their coordinates.
  const double size = std::max({p_from.cwiseAbs().maxCoeff(), p_to.cwiseAbs().maxCoeff(),
                                surface.origin().cwiseAbs().maxCoeff()});
  position_rounding_ = 0x1p-50 * (size / surface.step() + kLatticeHalf);
  const auto whole = [](double u) noexcept {
    return static_cast<std::int32_t>(std::clamp(u, -2 * kLatticeHalf, 2 * kLatticeHalf - 1));
  };
  const double room = 2 + 4 * position_rounding_;
  for (int i = 0; i < 3; ++i) {
    const double begin = from_[i], end = from_[i] + way_[i];
    low_[static_cast<std::size_t>(i)] = whole(std::min(begin, end) - room);
    high_[static_cast<std::size_t>(i)] = whole(std::max(begin, end) + room);
    from_whole_[static_cast<std::size_t>(i)] = whole(begin);
  }
  // Differences of corners and begin fit into 32 bits, and triple products into a float.
  single_ = from_.cwiseAbs().maxCoeff() < kLatticeHalf && way_size_ <= 4 * kLatticeHalf;
}

// Lane k is the side of edge k on which the segment's line passes: of two signs, one is wrong for a
// crossing. Nothing branches: which triangles of a list are near is beyond prediction.
std::size_t SegmentTest::select_near(std::span<const std::int32_t> list,
                                     std::int32_t* near) const noexcept {
  const auto all = [](std::int32_t v) noexcept { return _mm_set1_epi32(v); };
  const auto all_single = [](double v) noexcept { return _mm_set1_ps(static_cast<float>(v)); };
  const __m128i high_x = all(high_[0]), high_y = all(high_[1]), high_z = all(high_[2]);
  const __m128i low_x = all(low_[0]), low_y = all(low_[1]), low_z = all(low_[2]);
  const __m128i from_x = all(from_whole_[0]), from_y = all(from_whole_[1]),
                from_z = all(from_whole_[2]);
  const __m128 way_x = all_single(way_[0]), way_y = all_single(way_[1]),
               way_z = all_single(way_[2]);
  const __m128 way_size = all_single(way_size_), half_step = all_single(position_rounding_ + 1);
  const __m128 sign_bit = _mm_set1_ps(-0.0f);
  const unsigned unsure = single_ ? 0 : 1;
  const auto minor = [](__m128 a, __m128 b, __m128 next_a, __m128 next_b) noexcept {
    return _mm_sub_ps(_mm_mul_ps(a, next_b), _mm_mul_ps(b, next_a));
  };
  std::size_t count = 0;
  for (const std::int32_t t : list) {
    const CompactTriangle& record = surface_.record(t);
    const __m128i corners_x = load(record.x), corners_y = load(record.y),
                  corners_z = load(record.z);
    // Four bits per axis and side, of which the lowest three are the corners.
    const __m128i above = _mm_packs_epi16(
        _mm_packs_epi32(_mm_cmpgt_epi32(corners_x, high_x), _mm_cmpgt_epi32(corners_y, high_y)),
        _mm_packs_epi32(_mm_cmpgt_epi32(corners_z, high_z), _mm_cmplt_epi32(corners_x, low_x)));
    const __m128i below = _mm_packs_epi16(
        _mm_packs_epi32(_mm_cmplt_epi32(corners_y, low_y), _mm_cmplt_epi32(corners_z, low_z)),
        _mm_setzero_si128());
    const unsigned beside = static_cast<unsigned>(_mm_movemask_epi8(above)) |
                            static_cast<unsigned>(_mm_movemask_epi8(below)) << 16;
    const unsigned apart = beside & (beside >> 1) & (beside >> 2) & 0x111111u;

    const __m128 x = _mm_cvtepi32_ps(_mm_sub_epi32(corners_x, from_x));
    const __m128 y = _mm_cvtepi32_ps(_mm_sub_epi32(corners_y, from_y));
    const __m128 z = _mm_cvtepi32_ps(_mm_sub_epi32(corners_z, from_z));
    const __m128 next_x = next_corner(x), next_y = next_corner(y), next_z = next_corner(z);
    const __m128 side = _mm_add_ps(_mm_add_ps(_mm_mul_ps(way_x, minor(y, z, next_y, next_z)),
                                              _mm_mul_ps(way_y, minor(z, x, next_z, next_x))),
                                   _mm_mul_ps(way_z, minor(x, y, next_x, next_y)));
    const __m128 corner_size =
        _mm_max_ps(_mm_max_ps(_mm_andnot_ps(sign_bit, x), _mm_andnot_ps(sign_bit, y)),
                   _mm_andnot_ps(sign_bit, z));
    const __m128 size = _mm_max_ps(corner_size, next_corner(corner_size));
    const __m128 reach = _mm_add_ps(size, way_size);
    const __m128 wrong = _mm_add_ps(half_step, _mm_mul_ps(_mm_set1_ps(kSingleRounding), reach));
    const __m128 bound = _mm_mul_ps(_mm_mul_ps(_mm_set1_ps(static_cast<float>(kSpread)), wrong),
                                    _mm_mul_ps(size, reach));
    const auto left = static_cast<unsigned>(_mm_movemask_ps(_mm_cmpgt_ps(side, bound))) & 7u;
    const auto right =
        static_cast<unsigned>(_mm_movemask_ps(_mm_cmplt_ps(side, _mm_xor_ps(bound, sign_bit)))) &
        7u;
    const bool crossed = ((left == 0) | (right == 0) | unsure) != 0;
    near[count] = t;
    count += static_cast<std::size_t>(crossed & (apart == 0));
  }
  return count;
}

Crossing SegmentTest::cross(std::int32_t t, double& parameter) const noexcept {
  const CompactTriangle& record = surface_.record(t);
  const Vector3d a = record.corner(0) - from_;
  const Vector3d b = record.corner(1) - from_;
  const Vector3d c = record.corner(2) - from_;
  const double size =
      std::max({a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff(), c.cwiseAbs().maxCoeff()});
  const double reach = size + way_size_;
  const double bound = kSpread * (position_rounding_ + kRounding * reach) * size * reach;
  const int s0 = sign_beyond(way_.dot(a.cross(b)), bound);
  const int s1 = sign_beyond(way_.dot(b.cross(c)), bound);
  const int s2 = sign_beyond(way_.dot(c.cross(a)), bound);
  if (s0 * s1 < 0 || s1 * s2 < 0 || s2 * s0 < 0) return Crossing::kNone;
  const Vector3d n = (b - a).cross(c - a);
  const double above = -n.dot(a);
  const double below = n.dot(a - way_);
  const bool sure = s0 != 0 && s1 != 0 && s2 != 0;
  const int from = sign_beyond(above, 8 * bound);
  const int to = -sign_beyond(below, 8 * bound);
  if (from * to > 0) return Crossing::kNone;
  Crossing way = from > 0 ? Crossing::kEnters : Crossing::kLeaves;
  if (!sure || from == 0 || to == 0) {
    way = crossing(p_from_, p_to_, surface_.position(t, 0), surface_.position(t, 1),
                   surface_.position(t, 2));
  }
  if (way == Crossing::kNone) return way;
  // Rounding may make either end seem to lie on the other side: such a crossing is at that end.
  const double sign = way == Crossing::kEnters ? 1 : -1;
  parameter = 0;
  if (sign * above > 0) parameter = sign * below > 0 ? above / (above + below) : 1;
  parameter = kept_in_box(parameter, way_, a, b, c);
  return way;
}

double kept_in_box(double parameter, const Vector3d& way, const Vector3d& a, const Vector3d& b,
                   const Vector3d& c) noexcept {
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
  const double size = std::max(from.cwiseAbs().maxCoeff(), (from + way).cwiseAbs().maxCoeff());
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
