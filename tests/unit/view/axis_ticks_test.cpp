#include "view/playback/axis_ticks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "support/seed.h"

namespace thimble::view {
namespace {

std::vector<std::string> texts(const AxisTicks& ticks) {
  std::vector<std::string> all;
  for (std::size_t i = 0; i < ticks.count; ++i) all.push_back(ticks.text(i));
  return all;
}

using Texts = std::vector<std::string>;

TEST(AxisTicks, AreRoundNumbers) {
  EXPECT_EQ(texts(ticks_within(0, 1, 6)), (Texts{"0.0", "0.2", "0.4", "0.6", "0.8", "1.0"}));
  EXPECT_EQ(texts(ticks_within(0.13, 0.87, 4)), (Texts{"0.2", "0.4", "0.6", "0.8"}));
  EXPECT_EQ(texts(ticks_within(2.4312, 2.4318, 4)),
            (Texts{"2.4312", "2.4314", "2.4316", "2.4318"}));
  EXPECT_EQ(texts(ticks_within(-31, 62, 5)), (Texts{"-20", "0", "20", "40", "60"}));
  EXPECT_EQ(texts(ticks_around(0, 2.31, 4)), (Texts{"0", "1", "2", "3"}));
  EXPECT_EQ(texts(ticks_around(996, 1003.9, 5)), (Texts{"996", "998", "1000", "1002", "1004"}));
}

TEST(AxisTicks, FillTheRangeWithoutOverlap) {
  std::mt19937_64 random(support::seed_of(7));
  std::uniform_real_distribution<double> size(-6, 4);
  std::uniform_real_distribution<double> place(-3, 3);
  for (int i = 0; i < 2000; ++i) {
    const double width = std::pow(10, size(random));
    const double min = place(random) * width;
    const double max = min + width;
    const auto room = static_cast<std::size_t>(3 + i % 8);
    const double rim = 1e-5 * width;
    const AxisTicks within = ticks_within(min, max, room);
    ASSERT_GE(within.count, 1U);
    ASSERT_LE(within.count, room);
    EXPECT_GE(within.first, min - rim);
    EXPECT_LE(within.last(), max + rim);
    // With the next smaller round step they would overlap.
    EXPECT_GT(static_cast<double>(within.count) * 2.5 * within.step, width - 2 * within.step);
    const AxisTicks around = ticks_around(min, max, room);
    ASSERT_GE(around.count, 2U);
    ASSERT_LE(around.count, room);
    EXPECT_LE(around.first, min + rim);
    EXPECT_GE(around.last(), max - rim);
    for (const AxisTicks& ticks : {within, around}) {
      const double power = std::pow(10, std::floor(std::log10(ticks.step) + 1e-9));
      const double digit = ticks.step / power;
      EXPECT_TRUE(std::abs(digit - 1) < 1e-6 || std::abs(digit - 2) < 1e-6 ||
                  std::abs(digit - 5) < 1e-6)
          << ticks.step;
      for (std::size_t k = 0; k < ticks.count; ++k) {
        EXPECT_NEAR(std::stod(ticks.text(k)), ticks.at(k), 1e-3 * ticks.step);
        EXPECT_NE(ticks.text(k).substr(0, 2) == "-0" && std::stod(ticks.text(k)) == 0, true);
      }
    }
  }
}

TEST(AxisTicks, EmptyRangeHasNone) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(ticks_within(1, 1, 4).count, 0U);
  EXPECT_EQ(ticks_within(2, 1, 4).count, 0U);
  EXPECT_EQ(ticks_within(nan, 1, 4).count, 0U);
  EXPECT_EQ(ticks_around(0, std::numeric_limits<double>::infinity(), 4).count, 0U);
}

TEST(AxisTicks, ValuesHaveAReadableUnit) {
  EXPECT_EQ(with_unit(Quantity::kForce, 2.314), "2.31 N");
  EXPECT_EQ(with_unit(Quantity::kForce, -0.0456), "-45.6 mN");
  EXPECT_EQ(with_unit(Quantity::kLength, 0.01234), "12.3 mm");
  EXPECT_EQ(with_unit(Quantity::kLength, 3.21e-6), "3.21 um");
  EXPECT_EQ(with_unit(Quantity::kTime, 0.001), "1000 us");
  EXPECT_EQ(with_unit(Quantity::kTime, 0.25), "250 ms");
  EXPECT_EQ(with_unit(Quantity::kSpeed, 0.1), "100 mm/s");
  EXPECT_EQ(with_unit(Quantity::kForce, 0), "0.00 mN");
}

}  // namespace
}  // namespace thimble::view
