#pragma once

#include <bit>
#include <cstdint>

#include "math/double_double.h"
#include "math/elementary.h"
#include "math/tables.h"

namespace thimble::math {

/// Sine and cosine with more bits than a double has.
struct WideSineCosine {
  DoubleDouble sine;    ///< Sine of the angle.
  DoubleDouble cosine;  ///< Cosine of the angle.
};

/// Up to this angle (rad), the number of steps of pi / 64 fits 25 bits, and its products with the
/// parts of a step are exact.
inline constexpr double kNearAngle = 0x1p20;

/// Returns sine and cosine of any finite angle (rad) to 98 bits or more.
WideSineCosine wide_sine_cosine(double angle) noexcept;

/// Returns a rounded towards zero to 26 bits, by clearing the others.
inline double cut(double a) noexcept {
  return std::bit_cast<double>(std::bit_cast<std::uint64_t>(a) & ~std::uint64_t{0x7ffffff});
}

/// Adding and subtracting this rounds a number below 2^51 to an integer, which the lowest bits of
/// the sum also hold.
inline constexpr double kWhole = 0x1.8p52;

/// An angle as an integer number of steps of pi / 64 and a remainder.
struct NearAngle {
  std::uint64_t step = 0;  ///< Modulo 128.
  double hi = 0;           ///< Remainder, rad.
  double lo = 0;           ///< Rounding error of `hi`.
  bool good = false;       ///< Remainder has 64 good bits: not close to a multiple of pi / 64.
};

/// Returns the parts of an angle (rad) of at most `kNearAngle`, in the shortest time: `lo` is not
/// below the last place of `hi`, but below 2^-35.
inline NearAngle quick_angle(double angle) noexcept {
  constexpr double kTail = kSineStep[2] + kSineStep[3];
  const double shifted = angle * 0x1.45f306dc9c883p+4 + kWhole;  // 64 / pi, rounded
  const double steps = shifted - kWhole;
  const DoubleDouble most = exact_sum(angle - steps * kSineStep[0], -(steps * kSineStep[1]));
  return {std::bit_cast<std::uint64_t>(shifted) & 127, most.hi, most.lo - steps * kTail,
          steps == 0 || most.hi > 0x1p-20 || most.hi < -0x1p-20};
}

/// Returns the parts of an angle (rad) of at most `kNearAngle`.
inline NearAngle near_angle(double angle) noexcept {
  const NearAngle quick = quick_angle(angle);
  const DoubleDouble rest = quick_sum(quick.hi, quick.lo);
  return {quick.step, rest.hi, rest.lo, quick.good};
}

/// Common terms of sine and cosine of a remainder.
struct NearTurn {
  double cosine_less_1;  ///< cos(rest) - 1
  double sine_more;      ///< sin(rest) - hi
};

/// Returns them for a remainder of at most pi / 128: series up to 10^-22.
inline NearTurn near_turn(const NearAngle& a) noexcept {
  const double r2 = a.hi * a.hi;
  return {r2 * (-0.5 + r2 * (1. / 24 + r2 * (-1. / 720 + r2 * (1. / 40320)))) - a.hi * a.lo,
          a.lo + a.hi * r2 * (-1. / 6 + r2 * (1. / 120 + r2 * (-1. / 5040 + r2 * (1. / 362880))))};
}

/// Returns the sine at `step` plus the remainder, to 61 bits.
inline DoubleDouble near_sine(std::uint64_t step, const NearAngle& a, const NearTurn& t) noexcept {
  const DoubleDouble sine = kSines[step], cosine = kSines[step + 32];
  const double rest = cut(a.hi), slope = cut(cosine.hi);
  const DoubleDouble sum = quick_sum(sine.hi, slope * rest);  // an exact product
  const double small = slope * (a.hi - rest) + (cosine.hi - slope + cosine.lo) * a.hi;
  return quick_sum(
      sum.hi, sum.lo + (small + (sine.lo + (sine.hi * t.cosine_less_1 + cosine.hi * t.sine_more))));
}

/// Returns sine and cosine of an angle (rad) of at most `kNearAngle` whose remainder is good, to 61
/// bits.
inline WideSineCosine near_sine_cosine(const NearAngle& a) noexcept {
  const NearTurn t = near_turn(a);
  return {near_sine(a.step, a, t), near_sine((a.step + 32) & 127, a, t)};
}

/// Returns sine and cosine of an angle (rad) whose remainder is good, with an error below 1.2 units
/// in the last place. Series up to 10^-17, in sums with short dependency chains.
inline SineCosine quick_sine_cosine(const NearAngle& a) noexcept {
  const double r2 = a.hi * a.hi, r4 = r2 * r2;
  const double cosine_less_1 = (-0.5 * r2 - a.hi * a.lo) + r4 * (1. / 24 - r2 * (1. / 720));
  const double sine_more =
      (a.lo - 0.5 * r2 * a.lo) + a.hi * r2 * ((-1. / 6 + r2 * (1. / 120)) - r4 * (1. / 5040));
  const DoubleDouble s = kSines[a.step], c = kSines[a.step + 32];
  return {s.hi + (c.hi * a.hi + (c.hi * sine_more + (s.lo + s.hi * cosine_less_1))),
          c.hi + ((c.lo + c.hi * cosine_less_1) - s.hi * sine_more - s.hi * a.hi)};
}

}  // namespace thimble::math
