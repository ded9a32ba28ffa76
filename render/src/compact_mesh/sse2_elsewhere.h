#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#if defined(__aarch64__)
#include <arm_neon.h>
#endif

#ifndef _MM_SHUFFLE
#define _MM_SHUFFLE(w, z, y, x) ((w) << 6 | (z) << 4 | (y) << 2 | (x))
#endif

/// Of x86-64's SSE2 what this library computes with, in vectors of the compiler: on 64-bit ARM they
/// are NEON's. Each function gives the bits that <emmintrin.h> documents for its name, NaN and
/// zeros included, but for which NaN a NaN is; sse2_elsewhere_test compares them. Real-time: safe.
namespace thimble::render::sse2_elsewhere {

// NOLINTBEGIN: the names are Intel's.
using __m128 = float __attribute__((vector_size(16)));
using __m128d = double __attribute__((vector_size(16)));
using __m128i = long long __attribute__((vector_size(16), may_alias));
using Int4 = std::int32_t __attribute__((vector_size(16)));
using Unsigned4 = std::uint32_t __attribute__((vector_size(16)));
using Unsigned2 = std::uint64_t __attribute__((vector_size(16)));

#define THIMBLE_SSE2 [[gnu::always_inline]] inline

THIMBLE_SSE2 __m128 _mm_add_ps(__m128 a, __m128 b) noexcept {
  return a + b;
}
THIMBLE_SSE2 __m128 _mm_sub_ps(__m128 a, __m128 b) noexcept {
  return a - b;
}
THIMBLE_SSE2 __m128 _mm_mul_ps(__m128 a, __m128 b) noexcept {
  return a * b;
}
THIMBLE_SSE2 __m128 _mm_div_ps(__m128 a, __m128 b) noexcept {
  return a / b;
}
THIMBLE_SSE2 __m128 _mm_min_ps(__m128 a, __m128 b) noexcept {
  return a < b ? a : b;
}
THIMBLE_SSE2 __m128 _mm_max_ps(__m128 a, __m128 b) noexcept {
  return a > b ? a : b;
}
THIMBLE_SSE2 __m128 _mm_setzero_ps() noexcept {
  return __m128{};
}
THIMBLE_SSE2 __m128d _mm_add_pd(__m128d a, __m128d b) noexcept {
  return a + b;
}
THIMBLE_SSE2 __m128d _mm_sub_pd(__m128d a, __m128d b) noexcept {
  return a - b;
}
THIMBLE_SSE2 __m128d _mm_mul_pd(__m128d a, __m128d b) noexcept {
  return a * b;
}
THIMBLE_SSE2 __m128d _mm_min_pd(__m128d a, __m128d b) noexcept {
  return a < b ? a : b;
}
THIMBLE_SSE2 __m128d _mm_max_pd(__m128d a, __m128d b) noexcept {
  return a > b ? a : b;
}
THIMBLE_SSE2 __m128d _mm_setzero_pd() noexcept {
  return __m128d{};
}
THIMBLE_SSE2 __m128d _mm_add_sd(__m128d a, __m128d b) noexcept {
  return __m128d{a[0] + b[0], a[1]};
}
THIMBLE_SSE2 __m128d _mm_sub_sd(__m128d a, __m128d b) noexcept {
  return __m128d{a[0] - b[0], a[1]};
}
THIMBLE_SSE2 __m128d _mm_mul_sd(__m128d a, __m128d b) noexcept {
  return __m128d{a[0] * b[0], a[1]};
}
THIMBLE_SSE2 __m128d _mm_sqrt_sd(__m128d a, __m128d b) noexcept {
  return __m128d{std::sqrt(b[0]), a[1]};
}
THIMBLE_SSE2 __m128 _mm_sqrt_ps(__m128 a) noexcept {
  return __m128{std::sqrt(a[0]), std::sqrt(a[1]), std::sqrt(a[2]), std::sqrt(a[3])};
}
THIMBLE_SSE2 __m128 _mm_and_ps(__m128 a, __m128 b) noexcept {
  return (__m128)((Unsigned4)a & (Unsigned4)b);
}
THIMBLE_SSE2 __m128 _mm_andnot_ps(__m128 a, __m128 b) noexcept {
  return (__m128)(~(Unsigned4)a & (Unsigned4)b);
}
THIMBLE_SSE2 __m128 _mm_or_ps(__m128 a, __m128 b) noexcept {
  return (__m128)((Unsigned4)a | (Unsigned4)b);
}
THIMBLE_SSE2 __m128 _mm_castsi128_ps(__m128i a) noexcept {
  return (__m128)a;
}
THIMBLE_SSE2 __m128 _mm_set1_ps(float a) noexcept {
  return __m128{a, a, a, a};
}
THIMBLE_SSE2 __m128 _mm_setr_ps(float a, float b, float c, float d) noexcept {
  return __m128{a, b, c, d};
}
THIMBLE_SSE2 __m128d _mm_set1_pd(double a) noexcept {
  return __m128d{a, a};
}
THIMBLE_SSE2 __m128d _mm_set_pd(double high, double low) noexcept {
  return __m128d{low, high};
}
THIMBLE_SSE2 __m128d _mm_set_sd(double a) noexcept {
  return __m128d{a, 0};
}
THIMBLE_SSE2 __m128i _mm_set1_epi32(std::int32_t a) noexcept {
  return (__m128i)Int4{a, a, a, a};
}
THIMBLE_SSE2 __m128i _mm_setr_epi32(std::int32_t a, std::int32_t b, std::int32_t c,
                                    std::int32_t d) noexcept {
  return (__m128i)Int4{a, b, c, d};
}
THIMBLE_SSE2 __m128i _mm_setzero_si128() noexcept {
  return __m128i{};
}
THIMBLE_SSE2 __m128 _mm_load_ps(const float* from) noexcept {
  __m128 v{};
  std::memcpy(&v, from, 16);
  return v;
}
THIMBLE_SSE2 __m128 _mm_loadu_ps(const float* from) noexcept {
  __m128 v{};
  std::memcpy(&v, from, 16);
  return v;
}
THIMBLE_SSE2 __m128d _mm_load_pd(const double* from) noexcept {
  __m128d v{};
  std::memcpy(&v, from, 16);
  return v;
}
THIMBLE_SSE2 __m128d _mm_loadu_pd(const double* from) noexcept {
  __m128d v{};
  std::memcpy(&v, from, 16);
  return v;
}
THIMBLE_SSE2 __m128d _mm_load_sd(const double* from) noexcept {
  __m128d v{};
  std::memcpy(&v, from, 8);
  return v;
}
THIMBLE_SSE2 __m128i _mm_loadu_si128(const __m128i* from) noexcept {
  __m128i v{};
  std::memcpy(&v, from, 16);
  return v;
}
THIMBLE_SSE2 __m128i _mm_loadl_epi64(const __m128i* from) noexcept {
  __m128i v{};
  std::memcpy(&v, from, 8);
  return v;
}
THIMBLE_SSE2 void _mm_store_ps(float* to, __m128 v) noexcept {
  std::memcpy(to, &v, 16);
}
THIMBLE_SSE2 void _mm_store_pd(double* to, __m128d v) noexcept {
  std::memcpy(to, &v, 16);
}
THIMBLE_SSE2 void _mm_storel_epi64(__m128i* to, __m128i v) noexcept {
  std::memcpy(to, &v, 8);
}
THIMBLE_SSE2 float _mm_cvtss_f32(__m128 a) noexcept {
  return a[0];
}
THIMBLE_SSE2 double _mm_cvtsd_f64(__m128d a) noexcept {
  return a[0];
}
THIMBLE_SSE2 std::int32_t _mm_cvtsd_si32(__m128d a) noexcept {
  return static_cast<std::int32_t>(std::nearbyint(a[0])) /* within 32 bits */;
}
THIMBLE_SSE2 __m128i _mm_cvttpd_epi32(__m128d a) noexcept {
  const auto whole = [](double u) noexcept {
    return u > -2147483649.0 && u < 2147483648.0 ? static_cast<std::int32_t>(u)
                                                 : std::numeric_limits<std::int32_t>::min();
  };
  return (__m128i)Int4{whole(a[0]), whole(a[1]), 0, 0};
}
THIMBLE_SSE2 __m128d _mm_cvtepi32_pd(__m128i a) noexcept {
  return __m128d{static_cast<double>(((Int4)a)[0]), static_cast<double>(((Int4)a)[1])};
}
THIMBLE_SSE2 __m128 _mm_cvtepi32_ps(__m128i a) noexcept {
  return __builtin_convertvector((Int4)a, __m128);
}
THIMBLE_SSE2 __m128 _mm_cvtpd_ps(__m128d a) noexcept {
  return __m128{static_cast<float>(a[0]), static_cast<float>(a[1]), 0, 0};
}
THIMBLE_SSE2 __m128d _mm_cvtps_pd(__m128 a) noexcept {
  return __m128d{static_cast<double>(a[0]), static_cast<double>(a[1])};
}
THIMBLE_SSE2 __m128i _mm_sub_epi32(__m128i a, __m128i b) noexcept {
  return (__m128i)((Unsigned4)a - (Unsigned4)b);
}
THIMBLE_SSE2 __m128i _mm_slli_epi32(__m128i a, int bits) noexcept {
  return (__m128i)((Unsigned4)a << static_cast<std::uint32_t>(bits));
}
THIMBLE_SSE2 __m128i _mm_srai_epi32(__m128i a, int bits) noexcept {
  return (__m128i)((Int4)a >> bits);
}
// In parentheses: to clang these names are macros.
THIMBLE_SSE2 __m128(_mm_shuffle_ps)(__m128 a, __m128 b, int lanes) noexcept {
  return __m128{a[lanes & 3], a[lanes >> 2 & 3], b[lanes >> 4 & 3], b[lanes >> 6 & 3]};
}
THIMBLE_SSE2 __m128d(_mm_shuffle_pd)(__m128d a, __m128d b, int lanes) noexcept {
  return __m128d{a[lanes & 1], b[lanes >> 1 & 1]};
}
THIMBLE_SSE2 __m128i(_mm_shuffle_epi32)(__m128i a, int lanes) noexcept {
  const Int4 v = (Int4)a;
  return (__m128i)Int4{v[lanes & 3], v[lanes >> 2 & 3], v[lanes >> 4 & 3], v[lanes >> 6 & 3]};
}
THIMBLE_SSE2 __m128 _mm_movehl_ps(__m128 a, __m128 b) noexcept {
  return __m128{b[2], b[3], a[2], a[3]};
}
THIMBLE_SSE2 __m128 _mm_movelh_ps(__m128 a, __m128 b) noexcept {
  return __m128{a[0], a[1], b[0], b[1]};
}
THIMBLE_SSE2 __m128 _mm_unpacklo_ps(__m128 a, __m128 b) noexcept {
  return __m128{a[0], b[0], a[1], b[1]};
}
THIMBLE_SSE2 __m128 _mm_unpackhi_ps(__m128 a, __m128 b) noexcept {
  return __m128{a[2], b[2], a[3], b[3]};
}
THIMBLE_SSE2 __m128d _mm_unpackhi_pd(__m128d a, __m128d b) noexcept {
  return __m128d{a[1], b[1]};
}
THIMBLE_SSE2 __m128i _mm_unpacklo_epi8(__m128i a, __m128i b) noexcept {
  using Lanes = std::uint8_t __attribute__((vector_size(16)));
  return (__m128i)__builtin_shufflevector((Lanes)a, (Lanes)b, 0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5,
                                          21, 6, 22, 7, 23);
}
THIMBLE_SSE2 __m128i _mm_unpacklo_epi16(__m128i a, __m128i b) noexcept {
  using Lanes = std::uint16_t __attribute__((vector_size(16)));
  return (__m128i)__builtin_shufflevector((Lanes)a, (Lanes)b, 0, 8, 1, 9, 2, 10, 3, 11);
}
THIMBLE_SSE2 __m128i _mm_unpackhi_epi16(__m128i a, __m128i b) noexcept {
  using Lanes = std::uint16_t __attribute__((vector_size(16)));
  return (__m128i)__builtin_shufflevector((Lanes)a, (Lanes)b, 4, 12, 5, 13, 6, 14, 7, 15);
}
THIMBLE_SSE2 __m128i _mm_unpacklo_epi32(__m128i a, __m128i b) noexcept {
  using Lanes = std::uint32_t __attribute__((vector_size(16)));
  return (__m128i)__builtin_shufflevector((Lanes)a, (Lanes)b, 0, 4, 1, 5);
}
THIMBLE_SSE2 __m128i _mm_unpackhi_epi32(__m128i a, __m128i b) noexcept {
  using Lanes = std::uint32_t __attribute__((vector_size(16)));
  return (__m128i)__builtin_shufflevector((Lanes)a, (Lanes)b, 2, 6, 3, 7);
}
THIMBLE_SSE2 __m128i _mm_unpacklo_epi64(__m128i a, __m128i b) noexcept {
  using Lanes = std::uint64_t __attribute__((vector_size(16)));
  return (__m128i)__builtin_shufflevector((Lanes)a, (Lanes)b, 0, 2);
}
THIMBLE_SSE2 __m128i _mm_unpackhi_epi64(__m128i a, __m128i b) noexcept {
  using Lanes = std::uint64_t __attribute__((vector_size(16)));
  return (__m128i)__builtin_shufflevector((Lanes)a, (Lanes)b, 1, 3);
}
THIMBLE_SSE2 int _mm_movemask_ps(__m128 a) noexcept {
  const Unsigned4 signs = ((Unsigned4)a >> 31u) << Unsigned4{0, 1, 2, 3};
#if defined(__aarch64__)
  return static_cast<int>(vaddvq_u32((uint32x4_t)signs));
#else
  return static_cast<int>(signs[0] | signs[1] | signs[2] | signs[3]);
#endif
}
THIMBLE_SSE2 int _mm_movemask_pd(__m128d a) noexcept {
  const Unsigned2 signs = (Unsigned2)a >> 63u;
  return static_cast<int>(signs[0] | signs[1] << 1);
}

#undef THIMBLE_SSE2
// NOLINTEND

}  // namespace thimble::render::sse2_elsewhere
