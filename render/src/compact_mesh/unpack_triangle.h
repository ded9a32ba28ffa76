#pragma once

#include <cstdint>

#include "compact_mesh/packed_surface.h"
#include "compact_mesh/sse2.h"

// One packed triangle unpacked into lanes, three vectors or two sides at once; used by
// OffsetTriangle and rise_above. Real-time: safe.

namespace thimble::render::unpacked {

// Three vectors, one per lane; the fourth lane is any finite number.
struct Vectors {
  __m128 x, y, z;
};

template <unsigned kLane>
inline __m128 all(__m128 v) noexcept {
  return _mm_shuffle_ps(v, v, _MM_SHUFFLE(kLane, kLane, kLane, kLane));
}

inline double first(__m128 v) noexcept {
  return static_cast<double>(_mm_cvtss_f32(v));
}

inline __m128d swapped(__m128d v) noexcept {
  return _mm_shuffle_pd(v, v, 1);
}

// u_1 v_2 - u_2 v_1 of two pairs.
inline double cross_xy(__m128d u, __m128d v) noexcept {
  const __m128d products = _mm_mul_pd(u, swapped(v));
  return _mm_cvtsd_f64(_mm_sub_sd(products, _mm_unpackhi_pd(products, products)));
}

// One coordinate of corner 0, twice, and of the two sides from it.
struct Sides {
  explicit Sides(const std::int32_t* v) noexcept {
    const __m128i corners = _mm_loadu_si128(reinterpret_cast<const __m128i*>(v));
    corner = _mm_cvtepi32_pd(_mm_shuffle_epi32(corners, 0));
    both = _mm_sub_pd(_mm_cvtepi32_pd(_mm_shuffle_epi32(corners, _MM_SHUFFLE(2, 2, 2, 1))), corner);
  }
  // Differences from each corner to the next; the fourth lane is 0.
  __m128 edges() const noexcept {
    const __m128 sides = _mm_cvtpd_ps(both);  // side 1, side 2, 0, 0
    return _mm_sub_ps(sides, _mm_shuffle_ps(sides, sides, _MM_SHUFFLE(3, 1, 0, 3)));
  }
  __m128d corner, both;
};

// Differences from each corner's value to the next one's.
inline __m128 turn(__m128 v) noexcept {
  return _mm_sub_ps(_mm_shuffle_ps(v, v, _MM_SHUFFLE(3, 0, 2, 1)), v);
}

// Unpacks the three normals of a packed triangle; the same bits give the same normals.
inline Vectors unpack_normals(const PackedTriangle& r) noexcept {
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
  return {_mm_mul_ps(x, scale), _mm_mul_ps(y, scale), _mm_mul_ps(z, scale)};
}

inline __m128 dot(__m128 x, __m128 y, __m128 z, const Vectors& b) noexcept {
  return _mm_add_ps(_mm_add_ps(_mm_mul_ps(x, b.x), _mm_mul_ps(y, b.y)), _mm_mul_ps(z, b.z));
}

// (x_i - x_j) . (n_i - n_j) of the edges 01, 12 and 20.
inline __m128 bulges(const Sides& x, const Sides& y, const Sides& z, const Vectors& n) noexcept {
  return _mm_add_ps(_mm_add_ps(_mm_mul_ps(x.edges(), turn(n.x)), _mm_mul_ps(y.edges(), turn(n.y))),
                    _mm_mul_ps(z.edges(), turn(n.z)));
}

}  // namespace thimble::render::unpacked
