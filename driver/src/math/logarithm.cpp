#include <cmath>
#include <limits>

#include "math/elementary.h"
#include "math/power_parts.h"

namespace thimble::math {
namespace {

/// Returns the logarithm of a normal number above 0 to 98 bits.
DoubleDouble wide_logarithm(double x) noexcept {
  // 2^exponent m, m from 0.7 to 1.4.
  const std::uint64_t bits = std::bit_cast<std::uint64_t>(x);
  std::int64_t exponent = static_cast<std::int64_t>(bits >> 52) - 1023;
  double m = std::bit_cast<double>((bits & 0xfffffffffffff) | std::uint64_t{1023} << 52);
  if (m > 1.4) {
    m /= 2;
    ++exponent;
  }
  const DoubleDouble s = DoubleDouble{m - 1, 0} / exact_sum(m, 1);
  if (exponent == 0 && std::abs(m - 1) < 0.03125) {
    // log(m) = 2 atanh(s), a series up to 10^-33.
    const DoubleDouble s2 = s * s;
    DoubleDouble sum = kOddInverses[9];
    for (int n = 8; n >= 0; --n) sum = kOddInverses[n] + sum * s2;
    return scaled(s * sum, 2);
  }
  const double s2 = s.hi * s.hi;
  const double series =
      1 + s2 * (1. / 3 + s2 * (1. / 5 + s2 * (1. / 7 + s2 * (1. / 9 + s2 * (1. / 11 + s2 / 13)))));
  const double rough = 2 * s.hi * series;
  // log(m) = rough + log(m e^-rough), where the second term is below 10^-12.
  const WidePower power = wide_power({-rough, 0});
  const DoubleDouble table = scaled(power.table, power_of_2(power.exponent));
  const DoubleDouble z = (table + table * power.more) * m + -1.0;
  const DoubleDouble more = z - z * z * DoubleDouble{0.5, 0};
  return kLn2 * static_cast<double>(exponent) + (more + rough);
}

/// Returns x times 2^shift, normal, for x > 0.
double made_normal(double x, double& shift) noexcept {
  shift = x < 0x1p-1000 ? 100 : 0;
  return x < 0x1p-1000 ? x * 0x1p100 : x;
}

}  // namespace

double log(double x) noexcept {
  if (!(x > 0 && x < std::numeric_limits<double>::infinity())) {
    if (x == 0) return -std::numeric_limits<double>::infinity();
    return x > 0 ? x : x < 0 ? std::numeric_limits<double>::quiet_NaN() : x;
  }
  double shift = 0;
  const double normal = made_normal(x, shift);
  return (wide_logarithm(normal) - kLn2 * shift).hi;
}

double pow(double base, double x) noexcept {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (x == 0 || base == 1) return 1;
  if (std::isnan(base) || std::isnan(x)) return base + x;
  if (base < 0) return std::numeric_limits<double>::quiet_NaN();
  if (base == 0 || base == kInfinity) return (base == 0) == (x > 0) ? 0 : kInfinity;
  if (std::isinf(x)) return (base > 1) == (x > 0) ? kInfinity : 0;
  double shift = 0;
  const double normal = made_normal(base, shift);
  const DoubleDouble logarithm = wide_logarithm(normal) - kLn2 * shift;
  const double size = logarithm.hi * x;
  if (!(std::abs(size) < 760)) return size > 0 ? kInfinity : 0;
  // So small that the result is 1, and its product with the logarithm may be inexact.
  if (std::abs(size) < 0x1p-60) return 1;
  if (std::abs(x) > 0x1p900) return size > 0 ? kInfinity : 0;
  return rounded(wide_power(logarithm * x));
}

}  // namespace thimble::math
