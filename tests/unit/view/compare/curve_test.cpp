#include "view/playback/curve.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>

#include "view/compare/signal_curve.h"
#include "view/playback/channel_curve.h"

namespace thimble::view {
namespace {

SignalCurve random_signal(std::size_t count) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> any(-1, 1);
  auto time = std::make_shared<std::vector<double>>();
  std::vector<float> values;
  for (std::size_t i = 0; i < count; ++i) {
    // Some times occur more than once.
    time->push_back(time->empty() ? 0 : time->back() + 0.01 * static_cast<double>(random() % 3));
    values.push_back(any(random));
  }
  return {time, std::move(values)};
}

TEST(SignalCurve, ExtentOfAnyRangeHasItsPeaks) {
  const SignalCurve curve = random_signal(1000);
  std::mt19937 random(5);
  for (int i = 0; i < 300; ++i) {
    const double begin = 0.01 * static_cast<double>(random() % 1000);
    const TimeRange range{begin, begin + 0.01 * static_cast<double>(random() % 300)};
    Extent plain;
    for (std::size_t k = 0; k < curve.size(); ++k) {
      if (curve.time(k) < range.begin || curve.time(k) > range.end) continue;
      plain.add({curve.value(k), curve.value(k)});
    }
    const Extent fast = curve.extent(range);
    EXPECT_EQ(fast.min, plain.min);
    EXPECT_EQ(fast.max, plain.max);
  }
}

TEST(SignalCurve, HoldsItsValueBetweenSamplesAndHasNoneOutside) {
  const SignalCurve curve(std::make_shared<std::vector<double>>(std::vector{1.0, 2.0, 3.0}),
                          {10, 20, 30});
  EXPECT_EQ(curve.value_at(0.9), std::nullopt);
  EXPECT_EQ(curve.value_at(1), 10);
  EXPECT_EQ(curve.value_at(2.9), 20);
  EXPECT_EQ(curve.value_at(3), 30);
  EXPECT_EQ(curve.value_at(3.1), std::nullopt);
  EXPECT_EQ(curve.value_at(std::nan("")), std::nullopt);
}

TEST(ChannelCurve, IsShiftedToTheDrawnAxis) {
  Plots plots = Plots::of_recording();
  for (int i = 0; i < 100; ++i) {
    driver::TickRecord tick;
    tick.time_ns = 5'000'000'000 + i * std::int64_t{1'000'000};
    tick.f_sent_W = {0, 0, i == 40 ? 7.0 : 1.0};
    plots.add(tick);
  }
  const ChannelCurve curve(plots, Channel::kForce, 5);
  EXPECT_NEAR(curve.time(0), 0, 1e-12);
  EXPECT_EQ(curve.value_at(0.0405), 7);
  EXPECT_EQ(curve.value_at(5.0405), std::nullopt);
  EXPECT_EQ(curve.extent(TimeRange{0.02, 0.06}).max, 7);
  EXPECT_EQ(curve.extent(TimeRange{0.05, 0.06}).max, 1);
}

}  // namespace
}  // namespace thimble::view
