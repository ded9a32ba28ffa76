#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "compact_mesh/offset_place.h"
#include "compact_mesh/packed_surface.h"
#include "compact_mesh/sse2.h"
#include "compact_mesh/wide_lanes.h"
#include "mesh/depth_below_concave.h"

namespace thimble::render {

/// One packed triangle unpacked: a triangle that sinks along its corner normals. Offset by d along
/// them, a triangle x_i becomes the triangle x_i - d n_i. The place of a tip p is in the offset
/// triangle, with its own d, that contains p:
///
///        n_0        n_1          p = sum l_i (x_i - d n_i),  l_i >= 0, sum l_i = 1
///     x_0 \__________/ x_1       n_W = sum l_i n_i, normalised
///          \   q    /            depth = (q - p) . n_W + bend, q = sum l_i x_i
///           \__p___/             bend = sum l_i (x_i - q) . n_i / (1 + |sum l_i n_i|)
///
/// Where the surface is concave, `bend` is negative and the depth begins softly
/// (depth_below_concave). Neighbours share offset edges. `bend` is the height of a smooth surface
/// with these normals above the triangle, right to second order [PHYSICS 3]. As a sum over pairs of
/// corners its numerator is sum over i < j of l_i l_j (x_i - x_j) . (n_i - n_j). All Real-time:
/// safe. Points are in steps of the lattice.
///
/// The place of the tip is in double precision. Factors of the depth and of weights are in single
/// precision. This costs up to 3e-7 of the depth, and 1e-6 of a triangle's height at an edge
/// (offset_triangle_test.cpp).
class alignas(64) OffsetTriangle {
 public:
  /// Unpacks a packed triangle; equal packed triangles give bit-identical results.
  void unpack(const PackedTriangle& packed) noexcept;
  /// Does the same in eight lanes. Precondition: `wide_lanes` returns true.
  THIMBLE_FOR_AVX2 void unpack_wide(const PackedTriangle& packed) noexcept;
  /// Does the same on any processor, for callers that know the result of `wide_lanes`.
  void unpack_plain(const PackedTriangle& packed) noexcept;

  /// Returns the place of `p`; it depends only on `p` and the packed triangle.
  OffsetPlace locate(const Eigen::Vector3d& p) const noexcept;

  /// Returns direction and depth at a place. A place outside the triangle counts as on its border,
  /// because neither is known beyond.
  OffsetResponse feel(const OffsetPlace& place) const noexcept;

  /// Returns the same faster. Precondition: no weight is negative.
  OffsetResponse feel_within(const OffsetPlace& place) const noexcept;

  /// Returns the way from the tip to the point q of the triangle, the derivative of q by the tip
  /// (mesh/triangle_place.h), and minus the gradient of the felt depth. A place outside the
  /// triangle counts as on its border. Real-time: safe; some 100 ns, for stages that need the place
  /// itself, such as textures.
  PathToSurface path_to_surface(const OffsetPlace& place) const noexcept;

  /// Returns whether an edge is a crease, in bit k for edge k.
  std::uint32_t creases() const noexcept { return creases_; }
  /// Returns the number of the triangle in the input.
  std::int32_t source() const noexcept { return source_; }
  /// Returns the triangle's own unit normal.
  Eigen::Vector3d face() const noexcept { return {-h_[0], -h_[1], -h_[2]}; }

 private:
  OffsetPlace solve(__m128d ab, double h, double d) const noexcept;
  void unpack_here(const PackedTriangle& packed) noexcept;
  OffsetPlace locate_far(__m128d ab, double h, double d) const noexcept;

  using Pair = std::array<double, 2>;
  using Lanes = std::array<float, 4>;

  static __m128d pair(const Pair& v) noexcept { return _mm_load_pd(v.data()); }
  static __m128d swapped(__m128d v) noexcept { return _mm_shuffle_pd(v, v, 1); }
  static double low(__m128d v) noexcept { return _mm_cvtsd_f64(v); }
  static double high(__m128d v) noexcept { return _mm_cvtsd_f64(_mm_unpackhi_pd(v, v)); }

  // With the sides e_1, e_2 and the unit normal f a point is p - x_0 = a e_1 + b e_2 - h f, and the
  // corner normals are n_i = u_i e_1 + v_i e_2 + w_i f. Differences (D) are those to corner 0. A
  // pair is read in the form in which it was written, so that the processor can forward it before
  // it is in the cache.
  alignas(16) std::array<Pair, 4> ab_{};  // (a, b) per x, y, z and 1
  Pair uv_{};                             // (u, v) at corner 0
  Pair along_{};                          // (Du_1, Dv_2)
  Pair across_{};                         // (Du_2, Dv_1)
  Pair dw_{};                             // (Dw_1, Dw_2)
  std::array<Lanes, 3> n_{};              // normal at corner 0, differences at 1 and 2
  std::array<double, 4> h_{};             // h per x, y, z and 1
  std::array<double, 3> bulge_{};         // (x_i - x_j) . (n_i - n_j) of the edges 01, 12, 20
  double w_ = 0;                          // at corner 0
  double tilt_squared_ = 0;               // maximum of the normals against the face
  std::uint32_t creases_ = 0;
  std::int32_t source_ = -1;
};

/// Accuracy of `locate`, in steps: 3e-8 of the mesh's longest side.
inline constexpr double kPlaced = 64;

// Solves p = sum l_i (x_i - d n_i). In the triangle's own axes this is a pair of linear equations
// for the weights once d is known. d = h / sum l_i w_i, where the w_i are nearly 1.
inline OffsetPlace OffsetTriangle::locate(const Eigen::Vector3d& p) const noexcept {
  const __m128d ab =
      _mm_add_pd(_mm_add_pd(_mm_mul_pd(pair(ab_[0]), _mm_set1_pd(p.x())),
                            _mm_mul_pd(pair(ab_[1]), _mm_set1_pd(p.y()))),
                 _mm_add_pd(_mm_mul_pd(pair(ab_[2]), _mm_set1_pd(p.z())), pair(ab_[3])));
  const double h = (h_[0] * p.x() + h_[1] * p.y()) + (h_[2] * p.z() + h_[3]);
  // h / w without a division, good to (1 - w)^2: then one round is enough on most meshes.
  const __m128d rise = _mm_mul_pd(ab, pair(dw_));
  const double d = h * (2 - (w_ + low(rise) + high(rise)));
  OffsetPlace place = solve(ab, h, d);
  const double change = place.depth - d;
  // Written so that NaN ends the rounds.
  if (change * change * tilt_squared_ > kPlaced * kPlaced) [[unlikely]] {
    // Member by member, so that a place stays in registers on the common path.
    const OffsetPlace far = locate_far(ab, h, place.depth);
    place.l0 = far.l0;
    place.l1 = far.l1;
    place.l2 = far.l2;
    place.depth = far.depth;
    place.valid = far.valid;
  }
  return place;
}

inline OffsetPlace OffsetTriangle::solve(__m128d ab, double h, double d) const noexcept {
  // The matrix (m11 m12; m21 m22) and its determinant.
  const __m128d dd = _mm_set1_pd(d);
  const __m128d m11_m22 = _mm_sub_pd(_mm_set1_pd(1), _mm_mul_pd(dd, pair(along_)));
  const __m128d m12_m21 = _mm_mul_pd(dd, pair(across_));
  const __m128d m22_m11 = swapped(m11_m22);
  const double area = low(m11_m22) * low(m22_m11) - low(m12_m21) * high(m12_m21);
  const __m128d r = _mm_add_pd(ab, _mm_mul_pd(dd, pair(uv_)));
  const __m128d a12 = _mm_add_pd(_mm_mul_pd(r, m22_m11), _mm_mul_pd(m12_m21, swapped(r)));
  const __m128d aw = _mm_mul_pd(a12, pair(dw_));
  const double upright = area * w_ + (low(aw) + high(aw));
  // One division for the weights and the depth.
  const double both = 1 / (area * upright);
  const __m128d l12 = _mm_mul_pd(a12, _mm_set1_pd(upright * both));
  OffsetPlace place;
  place.l1 = low(l12);
  place.l2 = high(l12);
  place.l0 = 1 - place.l1 - place.l2;
  place.depth = h * area * area * both;
  // Turned over along one axis, the area is negative; along both, the sum is. Written so that NaN
  // counts as turned over: any of these makes the depth NaN.
  const double least = std::min(std::min(area, upright), low(m11_m22) + low(m22_m11));
  place.valid = least > 0 && place.depth <= std::numeric_limits<double>::max();
  return place;
}

inline OffsetResponse OffsetTriangle::feel(const OffsetPlace& place) const noexcept {
  if (place.l0 >= 0 && place.l1 >= 0 && place.l2 >= 0) return feel_within(place);
  OffsetPlace within = place;
  within.l0 = place.l0 > 0 ? place.l0 : 0;
  within.l1 = place.l1 > 0 ? place.l1 : 0;
  within.l2 = place.l2 > 0 ? place.l2 : 0;
  const double per_sum = 1 / (within.l0 + within.l1 + within.l2);
  within.l0 *= per_sum;
  within.l1 *= per_sum;
  within.l2 *= per_sum;
  return feel_within(within);
}

inline OffsetResponse OffsetTriangle::feel_within(const OffsetPlace& place) const noexcept {
  const auto row = [](const Lanes& v) noexcept { return _mm_load_ps(v.data()); };
  const __m128 l = _mm_cvtpd_ps(_mm_set_pd(place.l2, place.l1));
  const __m128 normal =
      _mm_add_ps(row(n_[0]), _mm_add_ps(_mm_mul_ps(row(n_[1]), _mm_shuffle_ps(l, l, 0x00)),
                                        _mm_mul_ps(row(n_[2]), _mm_shuffle_ps(l, l, 0x55))));
  const __m128d xy = _mm_cvtps_pd(normal);
  const __m128d z = _mm_cvtps_pd(_mm_movehl_ps(normal, normal));
  const __m128d squares = _mm_mul_pd(xy, xy);
  const __m128d sum =
      _mm_add_sd(_mm_add_sd(squares, _mm_unpackhi_pd(squares, squares)), _mm_mul_sd(z, z));
  const double squared = low(sum);
  // The bare instruction: no argument is negative, and errno is not used.
  const double size = low(_mm_sqrt_sd(sum, sum));
  const double rise =
      place.l1 * (place.l0 * bulge_[0] + place.l2 * bulge_[1]) + place.l2 * place.l0 * bulge_[2];
  // Divided by 1 + size instead of 2, the bend is exact on a sphere, however coarse. One division
  // for both quotients.
  const double both = 1 / (size + squared);
  const double per_size = (1 + size) * both;
  const __m128d n = _mm_mul_pd(xy, _mm_set1_pd(per_size));
  const double below = place.depth * size, bend = rise * (size * both);
  OffsetResponse felt{{low(n), high(n), low(z) * per_size}, below + bend};
  // Near the triangles of a concave place. Written so that NaN skips this.
  if (felt.depth < -bend && bend < 0 && below >= 0) [[unlikely]] {
    felt.depth = depth_below_concave(below, -bend);
  }
  return felt;
}

}  // namespace thimble::render
