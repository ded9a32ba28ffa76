#include <cmath>
#include <limits>

#include "math/elementary.h"
#include "math/power_parts.h"
#include "math/wide.h"

namespace thimble::math {
namespace {

/// Error bounds of e^x to 65 bits, and of e^x - 1 to 59, with a bit in reserve.
constexpr double kPowerDoubt = 0x1p-64;
constexpr double kLessOneDoubt = 0x1p-58;

/// The integer in the lowest bits of a sum with kWhole.
std::int64_t whole_of(double shifted) noexcept {
  return std::bit_cast<std::int64_t>(shifted) << 13 >> 13;
}

/// e^x - 1 of at most ln(2) / 128: a series up to 10^-38.
DoubleDouble power_of_rest(DoubleDouble rest) noexcept {
  DoubleDouble more = kInverseFactorials[13];
  for (int n = 12; n >= 2; --n) more = kInverseFactorials[n] + more * rest;
  return rest + more * (rest * rest);
}

/// e^x, x less than 708, as 2^exponent (whole + part): `whole` is from the table.
struct NearPower {
  double whole, part_hi, part_lo;
  std::int64_t exponent;
};

NearPower near_power(double x) noexcept {
  constexpr double kTail = kPowerStep[2] + kPowerStep[3];
  const double shifted = x * 0x1.71547652b82fep+6 + kWhole;  // 64 / ln(2), rounded
  const double steps = shifted - kWhole;
  const DoubleDouble most = exact_sum(x - steps * kPowerStep[0], -(steps * kPowerStep[1]));
  const double hi = most.hi, lo = most.lo - steps * kTail;
  const std::int64_t step = whole_of(shifted);
  const DoubleDouble table = kPowers[step & 63];
  // e^r - 1 - r: a series up to 10^-22.
  const double more =
      hi * hi *
      (0.5 + hi * (1. / 6 + hi * (1. / 24 + hi * (1. / 120 + hi * (1. / 720 + hi / 5040)))));
  const double rest = cut(hi), slope = cut(table.hi);
  const double small = slope * (hi - rest) + (table.hi - slope + table.lo) * hi;
  return {table.hi, slope * rest, small + (table.lo + table.hi * (more + lo + hi * lo)), step >> 6};
}

}  // namespace

WidePower wide_power(DoubleDouble x) noexcept {
  const double shifted = x.hi * 0x1.71547652b82fep+6 + kWhole;
  const double steps = shifted - kWhole;
  DoubleDouble rest = exact_sum(x.hi - steps * kPowerStep[0], -(steps * kPowerStep[1]));
  rest = rest + -(steps * kPowerStep[2]) + -(steps * kPowerStep[3]) + x.lo;
  const std::int64_t step = whole_of(shifted);
  return {kPowers[step & 63], power_of_rest(rest), step >> 6};
}

double rounded(const WidePower& power) noexcept {
  const DoubleDouble value = power.table + power.table * power.more;  // 0.99 to 2
  if (power.exponent > 1024) return std::numeric_limits<double>::infinity();
  if (power.exponent > 0) return value.hi * power_of_2(power.exponent - 1) * 2;
  if (power.exponent > -1022 || (power.exponent == -1022 && value.hi >= 1)) {
    return value.hi * power_of_2(power.exponent + 1) / 2;
  }
  if (power.exponent < -1080) return 0;
  // A denormal number: the last place of the sum is that of the result.
  const double shift = power_of_2(-1022 - power.exponent);
  const DoubleDouble sum = exact_sum(shift, value.hi);
  const double whole = sum.hi + (sum.lo + value.lo);
  return (whole - shift) * power_of_2(power.exponent + 1000) * 0x1p-1000;
}

double exp(double x) noexcept {
  if (!(std::abs(x) < 708)) {
    if (std::isnan(x)) return x;
    if (x > 710) return std::numeric_limits<double>::infinity();
    if (x < -746) return 0;
    return rounded(wide_power({x, 0}));
  }
  if (std::abs(x) <= 0x1p-54) return 1;
  const NearPower near = near_power(x);
  const DoubleDouble sum = quick_sum(near.whole, near.part_hi);
  const double rest = sum.lo + near.part_lo;
  const double low = sum.hi + (rest - 2 * kPowerDoubt), high = sum.hi + (rest + 2 * kPowerDoubt);
  if (low == high) return low * power_of_2(near.exponent);
  return rounded(wide_power({x, 0}));
}

double exp2(double x) noexcept {
  if (!(std::abs(x) < 1100)) {
    if (std::isnan(x)) return x;
    return x > 0 ? std::numeric_limits<double>::infinity() : 0;
  }
  // Steps of 1 / 64 are exact, and so is the remainder.
  const double shifted = x * 64 + kWhole;
  const std::int64_t step = whole_of(shifted);
  const DoubleDouble rest = kLn2 * (x - (shifted - kWhole) / 64);
  return rounded({kPowers[step & 63], power_of_rest(rest), step >> 6});
}

DoubleDouble wide_exp(DoubleDouble x) noexcept {
  if (x.hi < -700) return {0, 0};
  const WidePower power = wide_power(x);
  return scaled(power.table + power.table * power.more, power_of_2(power.exponent));
}

DoubleDouble wide_expm1(DoubleDouble x) noexcept {
  if (x.hi < -700) return {-1, 0};
  const WidePower power = wide_power(x);
  const DoubleDouble table = scaled(power.table, power_of_2(power.exponent));
  return (table + -1.0) + table * power.more;
}

double expm1(double x) noexcept {
  const double size = std::abs(x);
  if (!(size < 38)) {
    if (std::isnan(x)) return x;
    if (x < 0) return -1;  // the remainder is below half of its last place
    return x < 120 ? wide_expm1({x, 0}).hi : exp(x);
  }
  if (size <= 0x1p-54) return x;
  const NearPower near = near_power(x);
  const double power = power_of_2(near.exponent);
  const DoubleDouble less = exact_sum(near.whole * power, -1);
  const DoubleDouble sum = exact_sum(less.hi, near.part_hi * power);
  const double rest = sum.lo + (less.lo + near.part_lo * power);
  const double wrong = kLessOneDoubt * sum.hi;
  const double low = sum.hi + (rest - wrong), high = sum.hi + (rest + wrong);
  return low == high ? low : wide_expm1({x, 0}).hi;
}

double tanh(double x) noexcept {
  const double size = std::abs(x);
  if (std::isnan(x)) return x;
  if (size <= 0x1p-27) return x;  // x^3 / 3 is below half of its last place
  if (size >= 20) return std::copysign(1, x);
  const DoubleDouble more = wide_expm1({2 * size, 0});
  return std::copysign((more / (more + 2.0)).hi, x);
}

}  // namespace thimble::math
