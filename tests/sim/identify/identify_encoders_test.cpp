// Step and noise of encoders from their reports.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "bringup/identify/encoders.h"
#include "support/identify/identified_arm.h"
#include "support/random.h"

namespace thimble::bringup {
namespace {

using support::Random;

/// Returns reports whose counts have normal noise of `rms` (counts) before rounding.
std::vector<std::array<std::int32_t, 3>> noisy(double rms, double drift, std::uint64_t seed) {
  Random random(seed);
  std::vector<std::array<std::int32_t, 3>> counts(1000);
  for (std::size_t i = 0; i < counts.size(); ++i) {
    for (std::int32_t& count : counts[i]) {
      double off = drift * static_cast<double>(i) / 1000;
      for (int k = 0; k < 12; ++k) off += rms * random.uniform(-0.5, 0.5);
      count = static_cast<std::int32_t>(std::lround(off + 1000));
    }
  }
  return counts;
}

TEST(EncoderNoise, IntervalContainsTheTrueNoise) {
  constexpr double kRms = 1.5;
  const double truth = std::hypot(kRms, std::sqrt(1.0 / 12));  // rounding errors are uniform
  int held = 0, all = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const EncoderRest rest = noise_at_rest(noisy(kRms, 0, seed));
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_TRUE(rest.at_rest[i]);
      EXPECT_NEAR(rest.noise[i].value, truth, 0.25);
      held += rest.noise[i].holds(truth) ? 1 : 0;
      ++all;
    }
  }
  EXPECT_GE(held, 0.9 * all);
  EXPECT_LE(held, 0.99 * all);
}

TEST(EncoderNoise, NeedsAJointThatRestsWithChangingCounts) {
  const EncoderRest still = noise_at_rest(noisy(0, 0, 1));
  EXPECT_TRUE(still.at_rest[0]);
  EXPECT_EQ(still.noise[0].value, 0);
  // Changes of a count in less than 3 of 1000 reports.
  EXPECT_NEAR(still.noise[0].plus_minus, std::sqrt(0.003 / 2), 1e-4);
  EXPECT_FALSE(noise_at_rest(noisy(0, 5, 1)).at_rest[0]);
  EXPECT_FALSE(noise_at_rest(noisy(1.5, 5, 1)).at_rest[0]);
  EXPECT_FALSE(noise_at_rest({}).at_rest[0]);
}

TEST(EncoderStep, IgnoresMisreadCounts) {
  ArmMotion motion;
  motion.step = {1e-4, 1e-4, 1e-4};
  for (int k = 0; k < 400; ++k) {
    MotionSample sample;
    sample.fresh = k % 3 != 0;  // the others repeat the previous report
    const double way = 40 * std::sin(0.05 * k);
    sample.q = {1e-4 * std::round(way), 4e-4 * std::round(way / 4), 0};
    if (k == 200) sample.q[1] += 1e-4;
    motion.samples.push_back(sample);
  }
  const auto step = encoder_steps(motion);
  EXPECT_EQ(step[0].counts, 1);
  EXPECT_EQ(step[1].counts, 4);
  EXPECT_GT(step[1].seen, 10);
  EXPECT_EQ(step[2].counts, 0);
}

TEST(Encoders, SimulatedOnesCountByOneAndAreQuietAtRest) {
  const auto found =
      support::identified(support::hidden_arm(4), {.seconds = 10, .link = true, .seed = 4});
  ASSERT_TRUE(found.ok()) << found.error().message;
  for (const EncoderStep& step : found->encoders.step) EXPECT_EQ(step.counts, 1);
  ASSERT_TRUE(found->encoders.rest.has_value());
  EXPECT_GT(found->encoders.rest->reports, 900u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_TRUE(found->encoders.rest->at_rest[i]);
    EXPECT_EQ(found->encoders.rest->noise[i].value, 0);
  }
}

}  // namespace
}  // namespace thimble::bringup
