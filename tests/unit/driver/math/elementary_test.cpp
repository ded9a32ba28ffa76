#include "math/elementary.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>

#include "math/rough_arc.h"
#include "support/random.h"
#include "support/run_hash.h"
#include "unit/driver/math/elementary_functions.h"

namespace thimble::math {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kSmallest = std::numeric_limits<double>::denorm_min();

/// Equal including signs; all NaN are equal.
void expect_same(double found, double wanted) {
  if (std::isnan(wanted)) {
    EXPECT_TRUE(std::isnan(found)) << found;
  } else {
    EXPECT_EQ(std::bit_cast<std::uint64_t>(found), std::bit_cast<std::uint64_t>(wanted))
        << found << ", not " << wanted;
  }
}

TEST(Elementary, IsBitIdenticalOnEveryProcessorAndCompiler) {
  // Stored on a system on which each result equalled that of MPFR (elementary_mpfr_test.cpp).
  for (const Trial& trial : trials()) {
    support::Random random(std::uint64_t{11});
    support::RunHash hash;
    for (int i = 0; i < 20'000; ++i) {
      const double x = trial.x(random);
      const double y = trial.y(random);
      const double value = trial.function(x, y);
      hash.add(std::isnan(value) ? kNan : value);
    }
    EXPECT_EQ(hash.value(), trial.hash) << trial.name << ": 0x" << std::hex << hash.value();
  }
}

TEST(Elementary, PassesInfinitiesAndNanAsTheCLibraryDoes) {
  for (double (*f)(double) : {sin, cos, tan, asin, acos}) {
    for (const double bad : {kInfinity, -kInfinity, kNan}) expect_same(f(bad), kNan);
  }
  for (double (*f)(double) : {asin, acos}) expect_same(f(std::nextafter(1, 2)), kNan);
  for (double (*f)(double) : {exp, exp2, expm1, log, tanh, cbrt}) expect_same(f(kNan), kNan);
  expect_same(exp(kInfinity), kInfinity);
  expect_same(exp(-kInfinity), 0);
  expect_same(exp2(kInfinity), kInfinity);
  expect_same(exp2(-kInfinity), 0);
  expect_same(expm1(kInfinity), kInfinity);
  expect_same(expm1(-kInfinity), -1);
  expect_same(tanh(kInfinity), 1);
  expect_same(tanh(-kInfinity), -1);
  expect_same(cbrt(-kInfinity), -kInfinity);
  expect_same(log(kInfinity), kInfinity);
  expect_same(log(0), -kInfinity);
  expect_same(log(-1), kNan);
  expect_same(hypot(kNan, -kInfinity), kInfinity);
  expect_same(hypot(kNan, 1), kNan);
  expect_same(SineCosine(sin_cos(kInfinity)).cosine, kNan);
}

TEST(Elementary, KeepsTheSignOfZeroAndTheSmallestNumbers) {
  for (double (*f)(double) : {sin, tan, asin, expm1, tanh, cbrt}) {
    expect_same(f(0.0), 0.0);
    expect_same(f(-0.0), -0.0);
  }
  for (double (*f)(double) : {sin, tan, asin, expm1, tanh}) expect_same(f(-kSmallest), -kSmallest);
  for (double (*f)(double) : {cos, exp, exp2}) expect_same(f(kSmallest), 1);
  expect_same(cbrt(-kSmallest), -0x1p-358);
  expect_same(hypot(kSmallest, 0), kSmallest);
  expect_same(sin_cos(-0.0).sine, -0.0);
}

TEST(Elementary, KnowsTheDirectionOfEveryAxisAndCorner) {
  const double pi = 0x1.921fb54442d18p+1;
  expect_same(atan2(0, 1), 0);
  expect_same(atan2(-0.0, 1), -0.0);
  expect_same(atan2(0, -1), pi);
  expect_same(atan2(-0.0, -1), -pi);
  expect_same(atan2(0, 0), 0);
  expect_same(atan2(0, -0.0), pi);
  expect_same(atan2(-0.0, -0.0), -pi);
  expect_same(atan2(1, 0), pi / 2);
  expect_same(atan2(-1, -0.0), -pi / 2);
  expect_same(atan2(1, kInfinity), 0);
  expect_same(atan2(-1, kInfinity), -0.0);
  expect_same(atan2(1, -kInfinity), pi);
  expect_same(atan2(kInfinity, 1), pi / 2);
  expect_same(atan2(kInfinity, kInfinity), pi / 4);
  expect_same(atan2(-kInfinity, -kInfinity), -3 * (pi / 4));
  expect_same(atan2(kNan, 1), kNan);
  expect_same(acos(1), 0);
  expect_same(acos(-1), pi);
  expect_same(asin(-1), -pi / 2);
}

TEST(Elementary, PowersOfTheExtremesAreThoseOfTheCLibrary) {
  expect_same(pow(kNan, 0), 1);
  expect_same(pow(1, kNan), 1);
  expect_same(pow(2, kNan), kNan);
  expect_same(pow(0, 3), 0);
  expect_same(pow(0, -3), kInfinity);
  expect_same(pow(kInfinity, -1), 0);
  expect_same(pow(0.5, kInfinity), 0);
  expect_same(pow(0.5, -kInfinity), kInfinity);
  expect_same(pow(10, 3), 1000);
  expect_same(pow(10, -300), 1e-300);
  expect_same(pow(-8, 2), kNan);
}

TEST(Elementary, IsMonotonicAcrossItsPieces) {
  // At the boundaries between table entries, series and ranges of angles.
  const auto uphill = [](double (*f)(double), double at) {
    double x = at;
    for (int i = 0; i < 100; ++i) x = std::nextafter(x, -kInfinity);
    double last = f(x);
    for (int i = 0; i < 200; ++i) {
      x = std::nextafter(x, kInfinity);
      const double next = f(x);
      EXPECT_GE(next, last) << "at " << x;
      last = next;
    }
  };
  for (int i = -31; i < 32; ++i) uphill(sin, (i + 0.5) * 0x1.921fb54442d18p-5);
  for (int i = -700; i < 700; i += 7) uphill(exp, (i + 0.5) * 0x1.62e42fefa39efp-7);
  for (const double at : {-0x1p-54, 0x1p-54, 38.0, 120.0, 708.0}) uphill(expm1, at);
  for (const double at : {-708.0, -745.1, 708.0, 0x1p-54}) uphill(exp, at);
  for (const double at : {-0x1p-26, 0x1p-26, 0.5, 1 - 0x1p-40}) uphill(asin, at);
  for (const double at : {0x1p-27, 20.0}) uphill(tanh, at);
  for (const double at : {0.7, 0.96875, 1.0, 1.03125, 1.4, 0x1p-1000, 0x1p-1022}) uphill(log, at);
  for (const double at : {0x1p-900, 0x1p900, 1.0, 8.0}) uphill(cbrt, at);
}

TEST(Elementary, NoProductIsFusedWithASum) {
  // Rounding removes the lower 53 bits of the square of a 53-bit number; with a fused multiply-add
  // they would remain.
  support::Random random(7);
  const auto draw = between(1, 2);
  for (int i = 0; i < 1000; ++i) {
    const double a = draw(random);
    volatile double again = a, square = again * again;
    EXPECT_EQ(a * a - square, 0) << "this build fuses products with sums";
  }
}

/// Returns the distance between `found` and `wanted` in doubles.
std::int64_t steps_apart(double found, double wanted) {
  const auto place = [](double x) {
    const auto bits = std::bit_cast<std::int64_t>(x);
    return bits < 0 ? std::numeric_limits<std::int64_t>::min() - bits : bits;
  };
  return std::abs(place(found) - place(wanted));
}

TEST(Elementary, SineAndCosineAreWithinOneUlp) {
  support::Random random(std::uint64_t{3});
  support::RunHash hash;
  int next = 0;
  for (const auto& draw : {of_size(-40, 24), of_size(-1074, 1024), of_size(-3, 3)}) {
    for (int i = 0; i < 20'000; ++i) {
      const double x = draw(random);
      const auto [sine, cosine] = sin_cos(x);
      hash.add(sine);
      hash.add(cosine);
      ASSERT_LE(steps_apart(sine, sin(x)), 1) << std::hexfloat << x;
      ASSERT_LE(steps_apart(cosine, cos(x)), 1) << std::hexfloat << x;
      next += sine != sin(x) || cosine != cos(x) ? 1 : 0;
    }
  }
  EXPECT_LE(next, 3000) << "of 60,000";
  EXPECT_EQ(hash.value(), 0xb69a902ec97f98feu) << std::hex << hash.value();
}

TEST(Elementary, SineCosinePairIsAccurateAtEachTableStep) {
  for (int i = -200; i <= 200; ++i) {
    for (const double beside : {0.0, 0x1p-50, 0x1p-30, 0x1p-21, 0x1p-20, 0x1p-19, 0x1.9p-7}) {
      for (const double sign : {-1, 1}) {
        const double x = i * 0x1.921fb54442d18p-5 + sign * beside;
        ASSERT_LE(steps_apart(sin_cos(x).sine, sin(x)), 1) << std::hexfloat << x;
        ASSERT_LE(steps_apart(sin_cos(x).cosine, cos(x)), 1) << std::hexfloat << x;
      }
    }
  }
}

TEST(RoughArc, ErrorIsWithinItsReportedBound) {
  support::Random random(12);
  int known = 0;
  for (int i = 0; i < 200000; ++i) {
    const double y = random.uniform(-1, 1) * exp2(random.uniform(-40, 40));
    const double x = random.uniform(-1, 1) * exp2(random.uniform(-40, 40));
    const auto [angle, wrong] = rough_atan2(y, x);
    if (wrong == kInfinity) continue;
    ++known;
    const double true_angle = atan2(y, x);
    ASSERT_LE(std::abs(angle - true_angle), wrong) << y << ' ' << x;
    ASSERT_LE(wrong, 1e-12 * std::abs(true_angle));
  }
  EXPECT_GT(known, 150000);
  // The largest error of the series: halfway between two eighths.
  for (double slope = 0x1p-30; slope < 2; slope *= 1.0001) {
    const auto [angle, wrong] = rough_atan2(slope, 1);
    ASSERT_LE(std::abs(angle - atan2(slope, 1)), wrong) << slope;
  }
  for (const double far : {kInfinity, std::numeric_limits<double>::quiet_NaN(), 0.0, 0x1p-1000}) {
    EXPECT_EQ(rough_atan2(far, 1).wrong, kInfinity);
    EXPECT_EQ(rough_atan2(1, far).wrong, kInfinity);
  }
}

}  // namespace
}  // namespace thimble::math
