#include "compact_mesh/sse2_elsewhere.h"

#include <gtest/gtest.h>

#include "compact_mesh/sse2.h"
#include "support/random.h"

#if defined(__x86_64__)
namespace thimble::render {
namespace {

namespace other = sse2_elsewhere;

/// Equal bits; in single and double precision, all NaNs are equal.
template <class Lane, class One, class Other>
void expect_same(const One& one, const Other& other, const char* name) {
  static_assert(sizeof(one) == sizeof(other));
  constexpr std::size_t kCount = sizeof(one) / sizeof(Lane);
  Lane u[kCount], v[kCount];
  std::memcpy(u, &one, sizeof(one));
  std::memcpy(v, &other, sizeof(other));
  for (std::size_t i = 0; i < kCount; ++i) {
    const bool both_nan = u[i] != u[i] && v[i] != v[i];
    EXPECT_TRUE(both_nan || std::memcmp(&u[i], &v[i], sizeof(Lane)) == 0)
        << name << ", lane " << i << ": " << u[i] << " and " << v[i];
  }
}

/// Lanes of any bits, or of special numbers: zeros of both signs, infinities, NaN.
struct Input {
  alignas(16) float singles[2][4];
  alignas(16) double doubles[2][2];
  alignas(16) std::int32_t wholes[2][4];
};

Input draw(support::Random& random) {
  const float odd[] = {0, -0.0f, 1, -1, HUGE_VALF, -HUGE_VALF, NAN, 3e9f};
  const double odd_doubles[] = {0,        -0.0,      1.5,          -2.5,
                                HUGE_VAL, -HUGE_VAL, 2147483647.6, -2147483648.9};
  Input in;
  for (auto& four : in.singles) {
    for (float& v : four) {
      const auto bits = static_cast<std::uint32_t>(random.bits());
      std::memcpy(&v, &bits, sizeof(v));
      if (random.bits() % 2 == 0) v = odd[random.bits() % 8];
    }
  }
  for (auto& two : in.doubles) {
    for (double& v : two) {
      const std::uint64_t bits = random.bits();
      std::memcpy(&v, &bits, sizeof(v));
      if (random.bits() % 2 == 0) v = random.uniform(-3e9, 3e9);
      if (random.bits() % 4 == 0) v = odd_doubles[random.bits() % 8];
    }
  }
  for (auto& four : in.wholes) {
    for (std::int32_t& v : four) v = static_cast<std::int32_t>(random.bits());
  }
  return in;
}

template <class To, class From>
To as(const From& from) {
  To to;
  std::memcpy(&to, from, sizeof(to));
  return to;
}

TEST(Sse2Elsewhere, EveryFunctionIsBitIdenticalToSse2) {
  support::Random random(2);
  for (int round = 0; round < 20'000; ++round) {
    const Input in = draw(random);
    const auto a = as<__m128>(in.singles[0]), b = as<__m128>(in.singles[1]);
    const auto c = as<__m128d>(in.doubles[0]), d = as<__m128d>(in.doubles[1]);
    const auto i = as<__m128i>(in.wholes[0]), j = as<__m128i>(in.wholes[1]);
    const auto oa = as<other::__m128>(in.singles[0]), ob = as<other::__m128>(in.singles[1]);
    const auto oc = as<other::__m128d>(in.doubles[0]), od = as<other::__m128d>(in.doubles[1]);
    const auto oi = as<other::__m128i>(in.wholes[0]), oj = as<other::__m128i>(in.wholes[1]);
#define SINGLE_2(name) expect_same<float>(::name(a, b), other::name(oa, ob), #name)
#define DOUBLE_2(name) expect_same<double>(::name(c, d), other::name(oc, od), #name)
#define WHOLE_2(name) expect_same<std::int32_t>(::name(i, j), other::name(oi, oj), #name)
    SINGLE_2(_mm_add_ps);
    SINGLE_2(_mm_sub_ps);
    SINGLE_2(_mm_mul_ps);
    SINGLE_2(_mm_div_ps);
    SINGLE_2(_mm_min_ps);
    SINGLE_2(_mm_max_ps);
    SINGLE_2(_mm_and_ps);
    SINGLE_2(_mm_andnot_ps);
    SINGLE_2(_mm_or_ps);
    SINGLE_2(_mm_movehl_ps);
    SINGLE_2(_mm_movelh_ps);
    SINGLE_2(_mm_unpacklo_ps);
    SINGLE_2(_mm_unpackhi_ps);
    DOUBLE_2(_mm_add_pd);
    DOUBLE_2(_mm_sub_pd);
    DOUBLE_2(_mm_mul_pd);
    DOUBLE_2(_mm_min_pd);
    DOUBLE_2(_mm_max_pd);
    DOUBLE_2(_mm_add_sd);
    DOUBLE_2(_mm_sub_sd);
    DOUBLE_2(_mm_mul_sd);
    DOUBLE_2(_mm_sqrt_sd);
    DOUBLE_2(_mm_unpackhi_pd);
    WHOLE_2(_mm_sub_epi32);
    WHOLE_2(_mm_unpacklo_epi8);
    WHOLE_2(_mm_unpacklo_epi16);
    WHOLE_2(_mm_unpackhi_epi16);
    WHOLE_2(_mm_unpacklo_epi32);
    WHOLE_2(_mm_unpackhi_epi32);
    WHOLE_2(_mm_unpacklo_epi64);
    WHOLE_2(_mm_unpackhi_epi64);
    expect_same<float>(::_mm_sqrt_ps(a), other::_mm_sqrt_ps(oa), "_mm_sqrt_ps");
    expect_same<float>(::_mm_cvtpd_ps(c), other::_mm_cvtpd_ps(oc), "_mm_cvtpd_ps");
    expect_same<double>(::_mm_cvtps_pd(a), other::_mm_cvtps_pd(oa), "_mm_cvtps_pd");
    expect_same<float>(::_mm_cvtepi32_ps(i), other::_mm_cvtepi32_ps(oi), "_mm_cvtepi32_ps");
    expect_same<double>(::_mm_cvtepi32_pd(i), other::_mm_cvtepi32_pd(oi), "_mm_cvtepi32_pd");
    expect_same<std::int32_t>(::_mm_cvttpd_epi32(c), other::_mm_cvttpd_epi32(oc),
                              "_mm_cvttpd_epi32");
    expect_same<std::int32_t>(::_mm_slli_epi32(i, 16), other::_mm_slli_epi32(oi, 16),
                              "_mm_slli_epi32");
    expect_same<std::int32_t>(::_mm_srai_epi32(i, 16), other::_mm_srai_epi32(oi, 16),
                              "_mm_srai_epi32");
    expect_same<float>(_mm_shuffle_ps(a, b, _MM_SHUFFLE(3, 1, 0, 2)),
                       (other::_mm_shuffle_ps)(oa, ob, _MM_SHUFFLE(3, 1, 0, 2)), "_mm_shuffle_ps");
    expect_same<double>(_mm_shuffle_pd(c, d, 1), (other::_mm_shuffle_pd)(oc, od, 1),
                        "_mm_shuffle_pd");
    expect_same<std::int32_t>(_mm_shuffle_epi32(i, _MM_SHUFFLE(2, 3, 1, 0)),
                              (other::_mm_shuffle_epi32)(oi, _MM_SHUFFLE(2, 3, 1, 0)),
                              "_mm_shuffle_epi32");
    EXPECT_EQ(::_mm_movemask_ps(a), other::_mm_movemask_ps(oa));
    EXPECT_EQ(::_mm_movemask_pd(c), other::_mm_movemask_pd(oc));
    if (std::abs(in.doubles[0][0]) < 2147483647) {
      EXPECT_EQ(::_mm_cvtsd_si32(c), other::_mm_cvtsd_si32(oc)) << in.doubles[0][0];
    }
    expect_same<double>(::_mm_load_sd(in.doubles[0]), other::_mm_load_sd(in.doubles[0]),
                        "_mm_load_sd");
    if (HasFailure()) return;
  }
}

}  // namespace
}  // namespace thimble::render
#endif
