#include "hand/tremor.h"
#include "support/refuses.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

namespace thimble::device_sim {
namespace {

using support::refuses;

constexpr std::int64_t kTick = 1'000'000;  // ns

HandSettings tremulous(double amplitude) {
  HandSettings hand;
  hand.tremor_amplitude = amplitude;
  hand.tremor_frequency = 10;
  return hand;
}

TEST(Tremor, ApproachesButNeverExceedsItsAmplitude) {
  Tremor tremor = Tremor::make(tremulous(300e-6), 1).value();
  Eigen::Vector3d largest(0, 0, 0);
  for (int k = 0; k < 200000; ++k) largest = largest.cwiseMax(tremor.at(k * kTick).cwiseAbs());
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_LE(largest[axis], 300e-6 * (1 + 1e-12));
    EXPECT_GT(largest[axis], 0.9 * 300e-6);
  }
}

TEST(Tremor, KeepsItsPowerBetweenEightAndTwelveHertz) {
  Tremor tremor = Tremor::make(tremulous(1), 2).value();
  double inside = 0, outside = 0;
  // 100 s hold a whole number of periods of all three sines (8.3, 10 and 11.9 Hz), so no power
  // leaks.
  for (int cycle = 0; cycle < 3000; cycle += 10) {
    std::complex<double> sum = 0;
    for (int k = 0; k < 10000; ++k) {
      const double angle = -2 * std::numbers::pi * cycle * k / 10000.0;
      sum += tremor.at(10 * k * kTick).x() * std::polar(1e-4, angle);
    }
    (cycle >= 800 && cycle <= 1200 ? inside : outside) += std::norm(sum);
  }
  EXPECT_GT(inside, 0.01);
  EXPECT_LT(outside, 1e-20);
}

TEST(Tremor, DependsOnItsSeedOnly) {
  Tremor one = Tremor::make(tremulous(1), 5).value();
  Tremor same = Tremor::make(tremulous(1), 5).value();
  Tremor other = Tremor::make(tremulous(1), 6).value();
  EXPECT_EQ(one.at(1234 * kTick), same.at(1234 * kTick));
  EXPECT_NE(one.at(1234 * kTick), other.at(1234 * kTick));
}

// With even, uneven and changing steps, with repeated times, and backwards.
TEST(Tremor, IsIndependentOfTheStepSize) {
  const Tremor fresh = Tremor::make(tremulous(1), 7).value();
  Tremor tremor = fresh;
  std::int64_t time_ns = 0;
  double worst = 0;
  for (int k = 0; k < 100000; ++k) {
    const int part = k / 20000;
    if (part == 0) time_ns += kTick;
    if (part == 1) time_ns += kTick / 4;
    if (part == 2) time_ns += k % 3 == 0 ? 2 * kTick : kTick;
    if (part == 3) time_ns += k % 100 < 50 ? kTick : 0;
    if (part == 4) time_ns -= kTick;
    Tremor once = fresh;
    worst = std::max(worst, (tremor.at(time_ns) - once.at(time_ns)).norm());
  }
  EXPECT_LT(worst, 1e-12);
}

TEST(Tremor, IsExactlyStillWithoutAmplitude) {
  Tremor tremor = Tremor::make(tremulous(0), 1).value();
  EXPECT_EQ(tremor.at(3210 * kTick), Eigen::Vector3d(0, 0, 0));
}

TEST(Tremor, RefusesAmplitudesAndFrequenciesOutOfRange) {
  const auto amplitude = Tremor::make(tremulous(-1), 0);
  EXPECT_TRUE(refuses(amplitude, "amplitude"));
  HandSettings hand = tremulous(1);
  hand.tremor_frequency = std::numeric_limits<double>::infinity();
  const auto frequency = Tremor::make(hand, 0);
  EXPECT_TRUE(refuses(frequency, "frequency"));
}

}  // namespace
}  // namespace thimble::device_sim
