#include "compact_mesh/sse2.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "support/random.h"

namespace thimble::render {
namespace {

/// Hash (FNV-1a, 64 bits) of lanes. All NaN count as one, because processors differ in their bits.
class LaneHash {
 public:
  template <class Lane, class Vector>
  void add(const Vector& vector) {
    Lane lanes[sizeof(vector) / sizeof(Lane)];
    std::memcpy(lanes, &vector, sizeof(vector));
    for (Lane lane : lanes) {
      if (lane != lane) lane = std::numeric_limits<Lane>::quiet_NaN();
      unsigned char bytes[sizeof(Lane)];
      std::memcpy(bytes, &lane, sizeof(lane));
      for (const unsigned char byte : bytes) value_ = (value_ ^ byte) * 0x100000001b3;
    }
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325;
};

/// Arguments of the functions: random bits, or values whose combinations are special: zeros of both
/// signs, infinities, NaN.
struct Input {
  alignas(16) float singles[2][4];
  alignas(16) double doubles[2][2];
  alignas(16) std::int32_t integers[2][4];
};

Input draw(support::Random& random) {
  const float special[] = {0, -0.0f, 1, -1, HUGE_VALF, -HUGE_VALF, NAN, 3e9f};
  const double special_doubles[] = {0,        -0.0,      1.5,          -2.5,
                                    HUGE_VAL, -HUGE_VAL, 2147483647.6, -2147483648.9};
  Input in;
  for (auto& four : in.singles) {
    for (float& v : four) {
      const auto bits = static_cast<std::uint32_t>(random.bits());
      std::memcpy(&v, &bits, sizeof(v));
      if (random.bits() % 2 == 0) v = special[random.bits() % 8];
    }
  }
  for (auto& two : in.doubles) {
    for (double& v : two) {
      const std::uint64_t bits = random.bits();
      std::memcpy(&v, &bits, sizeof(v));
      if (random.bits() % 2 == 0) v = random.uniform(-3e9, 3e9);
      if (random.bits() % 4 == 0) v = special_doubles[random.bits() % 8];
    }
  }
  for (auto& four : in.integers) {
    for (std::int32_t& v : four) v = static_cast<std::int32_t>(random.bits());
  }
  return in;
}

// The hashes were stored on x86-64, where these are the processor's own instructions.
// tests/arm64.sh compares those of SIMDe on 64-bit ARM. Not compared: minimum and maximum of
// doubles of which one is NaN or both are zeros of other signs, and truncation of doubles from
// 2^31 - 1 to 2^31, which SIMDe makes -2^31. There SIMDe differs, and no caller depends on it:
// SegmentSieve limits its numbers to 2^31 - 2 (segment_sieve_test).

TEST(Sse2, FloatFunctionsGiveTheStoredHash) {
  support::Random random(std::uint64_t{2});
  LaneHash hash;
  alignas(16) float memory[4];
  for (int round = 0; round < 20'000; ++round) {
    const Input in = draw(random);
    const __m128 a = _mm_load_ps(in.singles[0]), b = _mm_loadu_ps(in.singles[1]);
    for (const __m128 result :
         {_mm_add_ps(a, b), _mm_sub_ps(a, b), _mm_mul_ps(a, b), _mm_div_ps(a, b), _mm_min_ps(a, b),
          _mm_max_ps(a, b), _mm_and_ps(a, b), _mm_andnot_ps(a, b), _mm_or_ps(a, b),
          _mm_movehl_ps(a, b), _mm_movelh_ps(a, b), _mm_unpacklo_ps(a, b), _mm_unpackhi_ps(a, b),
          _mm_sqrt_ps(a), _mm_setzero_ps(), _mm_set1_ps(in.singles[0][1]),
          _mm_setr_ps(1, in.singles[0][0], 3, in.singles[1][2]),
          _mm_shuffle_ps(a, b, _MM_SHUFFLE(3, 1, 0, 2))}) {
      hash.add<float>(result);
    }
    _mm_store_ps(memory, a);
    for (const float lane : memory) hash.add<float>(lane);
    hash.add<float>(_mm_cvtss_f32(b));
    hash.add<std::int32_t>(_mm_movemask_ps(a));
  }
  EXPECT_EQ(hash.value(), 7682738781140863794u);
}

TEST(Sse2, DoubleFunctionsGiveTheStoredHash) {
  support::Random random(std::uint64_t{3});
  LaneHash hash;
  alignas(16) double memory[2];
  for (int round = 0; round < 20'000; ++round) {
    const Input in = draw(random);
    const __m128d a = _mm_load_pd(in.doubles[0]), b = _mm_loadu_pd(in.doubles[1]);
    for (const __m128d result :
         {_mm_add_pd(a, b), _mm_sub_pd(a, b), _mm_mul_pd(a, b), _mm_add_sd(a, b), _mm_sub_sd(a, b),
          _mm_mul_sd(a, b), _mm_sqrt_sd(a, b), _mm_unpackhi_pd(a, b), _mm_setzero_pd(),
          _mm_set1_pd(in.doubles[0][1]), _mm_set_pd(in.doubles[0][0], in.doubles[1][1]),
          _mm_set_sd(in.doubles[0][0]), _mm_load_sd(in.doubles[1]), _mm_shuffle_pd(a, b, 1)}) {
      hash.add<double>(result);
    }
    if (_mm_movemask_pd(a) == _mm_movemask_pd(b) &&
        !std::isnan(in.doubles[0][0] + in.doubles[0][1]) &&
        !std::isnan(in.doubles[1][0] + in.doubles[1][1])) {
      hash.add<double>(_mm_min_pd(a, b));
      hash.add<double>(_mm_max_pd(a, b));
    }
    _mm_store_pd(memory, a);
    for (const double lane : memory) hash.add<double>(lane);
    hash.add<double>(_mm_cvtsd_f64(b));
    hash.add<std::int32_t>(_mm_movemask_pd(a));
  }
  EXPECT_EQ(hash.value(), 9820200708498834830u);
}

TEST(Sse2, IntegerFunctionsGiveTheStoredHash) {
  support::Random random(std::uint64_t{4});
  LaneHash hash;
  for (int round = 0; round < 20'000; ++round) {
    const Input in = draw(random);
    const auto a = _mm_loadu_si128(reinterpret_cast<const __m128i*>(in.integers[0]));
    const auto b = _mm_loadu_si128(reinterpret_cast<const __m128i*>(in.integers[1]));
    for (const __m128i result :
         {_mm_sub_epi32(a, b), _mm_unpacklo_epi8(a, b), _mm_unpacklo_epi16(a, b),
          _mm_unpackhi_epi16(a, b), _mm_unpacklo_epi32(a, b), _mm_unpackhi_epi32(a, b),
          _mm_unpacklo_epi64(a, b), _mm_unpackhi_epi64(a, b), _mm_slli_epi32(a, 16),
          _mm_srai_epi32(a, 16), _mm_setzero_si128(), _mm_set1_epi32(in.integers[0][2]),
          _mm_setr_epi32(1, in.integers[0][0], 3, in.integers[1][1]),
          _mm_loadl_epi64(reinterpret_cast<const __m128i*>(in.integers[1])),
          _mm_shuffle_epi32(a, _MM_SHUFFLE(2, 3, 1, 0))}) {
      hash.add<std::int32_t>(result);
    }
    std::int64_t low = 0;
    _mm_storel_epi64(reinterpret_cast<__m128i*>(&low), a);
    hash.add<std::int64_t>(low);
  }
  EXPECT_EQ(hash.value(), 5263000783905318497u);
}

TEST(Sse2, ConversionsGiveTheStoredHash) {
  support::Random random(std::uint64_t{5});
  LaneHash hash;
  for (int round = 0; round < 20'000; ++round) {
    const Input in = draw(random);
    const __m128 singles = _mm_load_ps(in.singles[0]);
    const __m128d doubles = _mm_load_pd(in.doubles[0]);
    const auto integers = _mm_loadu_si128(reinterpret_cast<const __m128i*>(in.integers[0]));
    hash.add<float>(_mm_cvtpd_ps(doubles));
    hash.add<double>(_mm_cvtps_pd(singles));
    hash.add<float>(_mm_cvtepi32_ps(integers));
    hash.add<double>(_mm_cvtepi32_pd(integers));
    const auto last = [](double v) { return v >= 2147483647.0 && v < 2147483648.0; };
    if (!last(in.doubles[0][0]) && !last(in.doubles[0][1]))
      hash.add<std::int32_t>(_mm_cvttpd_epi32(doubles));
    hash.add<float>(_mm_castsi128_ps(integers));
  }
  EXPECT_EQ(hash.value(), 659519887742741247u);
}

}  // namespace
}  // namespace thimble::render
