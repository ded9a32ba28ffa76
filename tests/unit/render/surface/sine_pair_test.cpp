#include "surface/texture/sine_pair.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include "math/elementary.h"
#include "support/random.h"
#include "support/run_hash.h"
#include "surface/texture/wave_sum.h"

namespace thimble::render {
namespace {

// Error of both polynomials, of the angle's own rounding and of the sums.
constexpr double kErrorMax = 2e-16;

TEST(SinePair, IsSineAndCosineOfBothAngles) {
  support::Random random(17);
  for (int i = 0; i < 20'000; ++i) {
    // Whole quarter turns and parts of them, with angles small enough to be exact in double
    // precision.
    const double whole[] = {std::floor(random.uniform(-1e6, 1e6)),
                            std::floor(random.uniform(-8, 8))};
    const double part[] = {std::round(random.uniform(-0.5, 0.5) * 0x1p30) * 0x1p-30,
                           std::round(random.uniform(-0.5, 0.5) * 0x1p30) * 0x1p-30};
    const SinePair found = sine_pair(Pair{whole[0] + part[0], whole[1] + part[1]});
    for (int k = 0; k < 2; ++k) {
      const double x = part[k] * (std::numbers::pi / 2);
      const double s = math::sin(x), c = math::cos(x);
      const auto turn = static_cast<long>(whole[k]) & 3;
      ASSERT_NEAR(found.sine[k], turn == 0 ? s : turn == 1 ? c : turn == 2 ? -s : -c, kErrorMax);
      ASSERT_NEAR(found.cosine[k], turn == 0 ? c : turn == 1 ? -s : turn == 2 ? -c : s, kErrorMax);
    }
  }
}

TEST(SinePair, IsBitIdenticalOnAllProcessorsAndCompilers) {
  support::Random random(std::uint64_t{18});
  support::RunHash hash;
  for (int i = 0; i < 20'000; ++i) {
    const SinePair found = sine_pair(Pair{random.uniform(-1e4, 1e4), random.uniform(-3, 3)});
    for (int k = 0; k < 2; ++k) {
      hash.add(double{found.sine[k]});
      hash.add(double{found.cosine[k]});
    }
  }
  EXPECT_EQ(hash.value(), 0xda957c8ccfe0178cu) << std::hex << hash.value();
}

TEST(SinePair, IsExactAtWholeQuartersAndPassesNan) {
  const SinePair found = sine_pair(Pair{1, std::numeric_limits<double>::quiet_NaN()});
  EXPECT_EQ(found.sine[0], 1);
  EXPECT_EQ(found.cosine[0], 0);
  EXPECT_TRUE(std::isnan(found.sine[1]) && std::isnan(found.cosine[1]));
}

TEST(SinePair, RepeatsAfterWholeTurnsUpToItsLargestAngles) {
  support::Random random(20);
  for (int i = 0; i < 1000; ++i) {
    const double quarters = std::floor(random.uniform(-8, 8)) / 4;  // exact also with many turns
    const double turns = std::floor(random.uniform(-0x1p48, 0x1p48 - 2));
    const SinePair found = sine_pair(Pair{quarters, quarters + 4 * turns});
    EXPECT_EQ(found.sine[0], found.sine[1]) << turns;
    EXPECT_EQ(found.cosine[0], found.cosine[1]) << turns;
  }
}

TEST(WaveSum, IsTheSumOfAnOddOrEvenNumberOfWaves) {
  support::Random random(19);
  for (std::size_t count = 0; count < 6; ++count) {
    std::vector<Wave> waves;
    double peak = 0;
    for (std::size_t i = 0; i < count; ++i) {
      waves.push_back({.amplitude = random.uniform(1e-5, 1e-4),
                       .k_M = random.in_box(3000),
                       .phase = random.uniform(-9, 9)});
      peak += waves.back().amplitude;
    }
    WaveSum sum(waves);
    for (const double factor : {1.0, 0.5}) {
      sum.scale(factor);  // the second time in addition to the first
      const Eigen::Vector3d p_M = random.in_box(0.1);
      double height = -peak * factor;
      Eigen::Vector3d slope_M = Eigen::Vector3d::Zero();
      for (const Wave& wave : waves) {
        const double angle = wave.k_M.dot(p_M) + wave.phase;
        height += factor * wave.amplitude * math::sin(angle);
        slope_M += factor * wave.amplitude * math::cos(angle) * wave.k_M;
      }
      const TextureHeight found = sum.at(p_M);
      EXPECT_NEAR(found.height, height, 1e-16);
      EXPECT_NEAR((found.slope_M - slope_M).norm(), 0, 1e-12);
      EXPECT_NEAR(sum.relief(), 2 * factor * peak, 1e-18);
    }
  }
}

}  // namespace
}  // namespace thimble::render
