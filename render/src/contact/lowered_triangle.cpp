#include "thimble/render/contact/lowered_triangle.h"

#include <emmintrin.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "thimble/render/contact/closest_point.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

// Below this the faces lie back to back and the plane between them is rounding (contact_mesh.cpp).
constexpr double kBackToBack = 1e-7;

// Unpacks the three normals of a record side by side; the same bits give the same normals.
std::array<Vector3d, 3> unpack_normals(const CompactTriangle& r) noexcept {
  // The fourth lane is a neighbour's number: any bits are a finite normal.
  const __m128i packed = _mm_loadu_si128(reinterpret_cast<const __m128i*>(r.normals.data()));
  const __m128 sign = _mm_set1_ps(-0.0f);
  __m128 x = _mm_cvtepi32_ps(_mm_srai_epi32(_mm_slli_epi32(packed, 16), 16));
  __m128 y = _mm_cvtepi32_ps(_mm_srai_epi32(packed, 16));
  const __m128 z = _mm_sub_ps(_mm_set1_ps(kOctahedron),
                              _mm_add_ps(_mm_andnot_ps(sign, x), _mm_andnot_ps(sign, y)));
  const __m128 fold = _mm_max_ps(_mm_sub_ps(_mm_setzero_ps(), z), _mm_setzero_ps());
  x = _mm_sub_ps(x, _mm_or_ps(fold, _mm_and_ps(sign, x)));
  y = _mm_sub_ps(y, _mm_or_ps(fold, _mm_and_ps(sign, y)));
  const __m128 squared =
      _mm_add_ps(_mm_add_ps(_mm_mul_ps(x, x), _mm_mul_ps(y, y)), _mm_mul_ps(z, z));
  const __m128 scale = _mm_div_ps(_mm_set1_ps(1), _mm_sqrt_ps(squared));
  alignas(16) std::array<float, 4> nx, ny, nz;
  _mm_store_ps(nx.data(), _mm_mul_ps(x, scale));
  _mm_store_ps(ny.data(), _mm_mul_ps(y, scale));
  _mm_store_ps(nz.data(), _mm_mul_ps(z, scale));
  std::array<Vector3d, 3> normals;
  for (std::size_t k = 0; k < 3; ++k) {
    normals[k] = {static_cast<double>(nx[k]), static_cast<double>(ny[k]),
                  static_cast<double>(nz[k])};
  }
  return normals;
}

}  // namespace

void LoweredTriangle::unpack(const CompactTriangle& r) noexcept {
  creases_ = r.flags & 7u;
  source_ = r.source();
  normals_ = unpack_normals(r);
  corner_ = r.corner(0);
  side_1_ = r.corner(1) - corner_;
  side_2_ = r.corner(2) - corner_;
  const Vector3d area = side_1_.cross(side_2_);
  const double squared = area.squaredNorm();
  const double per_squared = 1 / squared;
  face_ = area * (1 / std::sqrt(squared));
  dual_1_ = side_2_.cross(area) * per_squared;
  dual_2_ = area.cross(side_1_) * per_squared;
  const auto& n = normals_;
  const auto along = [&n](const Vector3d& axis) noexcept -> std::array<double, 3> {
    const double first = axis.dot(n[0]);
    return {first, axis.dot(n[1]) - first, axis.dot(n[2]) - first};
  };
  u_ = along(dual_1_);
  v_ = along(dual_2_);
  w_ = along(face_);
  rise_1_ = side_1_.dot(n[1]);
  rise_2_ = side_2_.dot(n[2]);
  const double least = w_[0] + std::min({0.0, w_[1], w_[2]});
  tilt_squared_ = std::max(1 - least * least, 0.0);
}

LoweredFeel LoweredTriangle::feel_nearest(const Vector3d& p) const noexcept {
  const Vector3d q = closest_point(p, corner_, corner_ + side_1_, corner_ + side_2_);
  LoweredPlace place;
  place.l1 = dual_1_.dot(q - corner_);
  place.l2 = dual_2_.dot(q - corner_);
  place.l0 = 1 - place.l1 - place.l2;
  LoweredFeel felt = feel(place);
  felt.depth = std::max((q - p).dot(felt.n_W), 0.0);
  return felt;
}

double LoweredTriangle::side_of_crease(const Vector3d& p, std::size_t edge,
                                       const CompactTriangle& other) const noexcept {
  const Vector3d o0 = other.corner(0);
  const Vector3d other_area = (other.corner(1) - o0).cross(other.corner(2) - o0);
  const Vector3d average = face_ + other_area / std::sqrt(other_area.squaredNorm());
  const double size = average.norm();
  if (!(size > kBackToBack)) return 0;
  const std::array<Vector3d, 3> corners{corner_, corner_ + side_1_, corner_ + side_2_};
  const Vector3d& begin = corners[edge];
  const Vector3d along = corners[(edge + 1) % 3] - begin;
  const double twice_area = side_1_.cross(side_2_).norm();
  return average.cross(along).dot(p - begin) / (size * twice_area);
}

}  // namespace thimble::render
