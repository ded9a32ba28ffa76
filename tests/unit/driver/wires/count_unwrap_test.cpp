// Continuous counts of encoder counters that wrap around.
#include "wires/count_unwrap.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "support/random.h"

namespace thimble::driver {
namespace {

using Counts = std::array<std::int32_t, 3>;

/// Takes one counter of 8 bits; returns its count, or 9999 if the step is refused.
std::int32_t take(CountUnwrap& unwrap, std::int32_t raw) {
  Counts counts{raw, 0, 0};
  return unwrap.take({8, 0, 0}, counts) ? counts[0] : 9999;
}

TEST(CountUnwrap, FirstReportIsTheValueNearestToZero) {
  for (const auto& [raw, count] : {std::pair(5, 5), {127, 127}, {250, -6}, {-6, -6}, {128, -128}}) {
    CountUnwrap unwrap;
    EXPECT_EQ(take(unwrap, raw), count) << raw;
  }
}

TEST(CountUnwrap, ContinuesBeyondBothEndsOfTheRange) {
  CountUnwrap up, down;
  for (int count = 0; count < 2000; count += 25) {
    EXPECT_EQ(take(up, count & 255), count);
    EXPECT_EQ(take(down, -count & 255), -count);
  }
}

TEST(CountUnwrap, StepAboveAQuarterIsRefusedAndChangesNothing) {
  CountUnwrap unwrap;
  ASSERT_EQ(take(unwrap, 100), 100);
  EXPECT_EQ(take(unwrap, 165), 9999);
  EXPECT_EQ(take(unwrap, 35), 9999);
  EXPECT_EQ(take(unwrap, 164), 164);  // exactly a quarter
  EXPECT_EQ(take(unwrap, 100), 100);
}

TEST(CountUnwrap, RefusedCounterLeavesTheOthersUnchanged) {
  CountUnwrap unwrap;
  Counts counts{10, 20, 30};
  ASSERT_TRUE(unwrap.take({8, 16, 0}, counts));
  Counts jump{12, 30'020, 31};
  const Counts before = jump;
  EXPECT_FALSE(unwrap.take({8, 16, 0}, jump));
  EXPECT_EQ(jump, before);
  Counts next{73, 20, 1'000'000};  // 63 above the first 10
  EXPECT_TRUE(unwrap.take({8, 16, 0}, next));
  EXPECT_EQ(next, (Counts{73, 20, 1'000'000}));
}

TEST(CountUnwrap, FollowsARandomWalkOfEveryWidth) {
  support::Random random(71);
  for (unsigned bits = 8; bits <= 31; ++bits) {
    CountUnwrap unwrap;
    const std::int64_t quarter = std::int64_t{1} << (bits - 2);
    const auto mask = static_cast<std::uint32_t>((std::uint64_t{1} << bits) - 1);
    std::int64_t count = 0;
    for (int i = 0; i < 2000; ++i) {
      const auto step = static_cast<std::int64_t>(random.bits() % (2 * quarter + 1)) - quarter;
      if (std::abs(count + step) < (1 << 30)) count += step;
      const auto raw = static_cast<std::int32_t>(static_cast<std::uint32_t>(count) & mask);
      Counts counts{raw, 0, 0};
      ASSERT_TRUE(unwrap.take({static_cast<std::uint8_t>(bits), 0, 0}, counts)) << bits;
      ASSERT_EQ(counts[0], count) << bits << " bits, step " << i;
    }
  }
}

TEST(CountUnwrap, CountsAreBounded) {
  CountUnwrap unwrap;
  std::int64_t count = 0;
  int refused = 0;
  for (int i = 0; i < 6; ++i) {
    count += std::int64_t{1} << 28;
    Counts counts{static_cast<std::int32_t>(static_cast<std::uint32_t>(count) & 0x3fffffff), 0, 0};
    refused += unwrap.take({30, 0, 0}, counts) ? 0 : 1;
    EXPECT_LE(std::abs(counts[0]), 1 << 30);
  }
  EXPECT_EQ(refused, 2);  // the first four steps end at the bound
}

}  // namespace
}  // namespace thimble::driver
