#include "view/playback/plots.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "support/seed.h"

namespace thimble::view {
namespace {

driver::TickRecord tick(double time, double force) {
  driver::TickRecord record;
  record.time_ns = std::llround(1e9 * time);
  record.f_sent_W = {0, force, 0};
  record.p_WT = {0.1 * time, 0, 0};
  record.v_WT = {0, 0, 0.02};
  return record;
}

TEST(Plots, FindMinAndMaxOfAnyRange) {
  Plots plots;
  std::mt19937_64 random(support::seed_of(3));
  std::uniform_real_distribution<double> any(0, 4);
  std::vector<double> forces;
  // More than a minute, so that the first ticks are forgotten and blocks start anywhere.
  constexpr int kTicks = 70'037;
  for (int i = 0; i < kTicks; ++i) {
    forces.push_back(any(random));
    plots.add(tick(1e-3 * i, forces.back()));
  }
  EXPECT_NEAR(plots.kept().width(), Plots::kSeconds, 2e-3);
  std::uniform_int_distribution<int> place(kTicks - 59'000, kTicks - 1);
  for (int i = 0; i < 200; ++i) {
    const int one = place(random);
    const int other = place(random);
    const int from = std::min(one, other);
    const int to = i % 2 == 0 ? std::max(one, other) : std::min(from + i, kTicks - 1);
    const auto [min, max] = std::minmax_element(forces.begin() + from, forces.begin() + to + 1);
    const Plots::Extent found =
        plots.extent(Channel::kForce, {1e-3 * from - 1e-7, 1e-3 * to + 1e-7});
    EXPECT_FLOAT_EQ(found.min, static_cast<float>(*min));
    EXPECT_FLOAT_EQ(found.max, static_cast<float>(*max));
  }
}

TEST(Plots, ReturnValueOfLastTickNotLater) {
  Plots plots;
  for (int i = 0; i < 100; ++i) plots.add(tick(0.01 * i, i));
  EXPECT_EQ(plots.value_at(Channel::kForce, 0.505), 50);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(plots.value_at(Channel::kForce, i / 100.0), i);
  EXPECT_NEAR(*plots.value_at(Channel::kX, 0.5), 0.05, 1e-6);
  EXPECT_NEAR(*plots.value_at(Channel::kSpeed, 0.5), 0.02, 1e-6);
  EXPECT_NEAR(*plots.value_at(Channel::kPeriod, 0.5), 0.01, 1e-6);
  EXPECT_EQ(plots.value_at(Channel::kForce, -0.1), std::nullopt);
  EXPECT_EQ(plots.value_at(Channel::kForce, 1.5), std::nullopt);
  EXPECT_EQ(plots.value_at(Channel::kForce, std::nan("")), std::nullopt);
}

TEST(Plots, KeepAMinuteOfARunAndAllOfARecording) {
  Plots run;
  Plots recording = Plots::of_recording();
  for (int i = 0; i < 9000; ++i) {
    run.add(tick(0.01 * i, 1));
    recording.add(tick(0.01 * i, 1));
  }
  EXPECT_NEAR(run.kept().width(), Plots::kSeconds, 0.02);
  EXPECT_NEAR(recording.kept().width(), 89.99, 1e-6);
  run.add(tick(0, 1));  // another run
  EXPECT_EQ(run.kept().width(), 0);
  EXPECT_EQ(Plots().kept().end, 0);
}

TEST(Plots, ZoomAroundTheMouseWithinTheRecording) {
  const TimeRange all{0, 10};
  const TimeRange closer = zoomed({0, 10}, 4, 0.5, all);
  EXPECT_DOUBLE_EQ(closer.begin, 2);
  EXPECT_DOUBLE_EQ(closer.end, 7);
  const TimeRange out = zoomed(closer, 4, 100, all);
  EXPECT_EQ(out.begin, 0);
  EXPECT_EQ(out.end, 10);
  TimeRange range = all;
  for (int i = 0; i < 200; ++i) range = zoomed(range, 9.9, 0.8, all);
  EXPECT_GE(range.width(), 0.9e-4);
  EXPECT_LE(range.end, 10);
  const TimeRange moved = shifted({2, 7}, 100, all);
  EXPECT_DOUBLE_EQ(moved.begin, 5);
  EXPECT_DOUBLE_EQ(moved.end, 10);
}

}  // namespace
}  // namespace thimble::view
