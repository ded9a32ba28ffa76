#pragma once

#include <bit>
#include <cstdint>

#include "math/double_double.h"
#include "math/elementary.h"
#include "math/tables.h"

namespace thimble::math {

/// Sine and cosine with more bits than a double has.
struct WideSineCosine {
  DoubleDouble sine;    ///< Of the angle.
  DoubleDouble cosine;  ///< Of the angle.
};

/// Up to here an angle (rad) takes 25 bits of steps of pi / 64, whose parts are then exact.
inline constexpr double kNearAngle = 0x1p20;

/// Returns sine and cosine of any finite angle (rad) to 98 bits or more.
WideSineCosine wide_sine_cosine(double angle) noexcept;

/// Returns a rounded towards zero to 26 bits, by clearing the others.
inline double cut(double a) noexcept {
  return std::bit_cast<double>(std::bit_cast<std::uint64_t>(a) & ~std::uint64_t{0x7ffffff});
}

/// Adding and taking off this rounds a number below 2^51 to a whole one, which the lowest bits of
/// the sum hold as well.
inline constexpr double kWhole = 0x1.8p52;

/// An angle as a whole number of steps of pi / 64 and a rest.
struct NearAngle {
  std::uint64_t step = 0;  ///< Modulo 128.
  double hi = 0;           ///< The rest, rad.
  double lo = 0;           ///< What `hi` lacks.
  bool good = false;       ///< Whether the rest has 64 good bits: not beside a multiple of pi / 64.
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

/// What both functions of the rest of an angle are made of.
struct NearTurn {
  double cosine_less_1;  ///< cos(rest) - 1
  double sine_more;      ///< sin(rest) - hi
};

/// Returns them for a rest of at most pi / 128: series up to 10^-22.
inline NearTurn near_turn(const NearAngle& a) noexcept {
  const double r2 = a.hi * a.hi;
  return {r2 * (-0.5 + r2 * (1. / 24 + r2 * (-1. / 720 + r2 * (1. / 40320)))) - a.hi * a.lo,
          a.lo + a.hi * r2 * (-1. / 6 + r2 * (1. / 120 + r2 * (-1. / 5040 + r2 * (1. / 362880))))};
}

/// Returns the sine at `step` plus the rest, to 61 bits.
inline DoubleDouble near_sine(std::uint64_t step, const NearAngle& a, const NearTurn& t) noexcept {
  const DoubleDouble sine = kSines[step], cosine = kSines[step + 32];
  const double rest = cut(a.hi), slope = cut(cosine.hi);
  const DoubleDouble sum = quick_sum(sine.hi, slope * rest);  // an exact product
  const double small = slope * (a.hi - rest) + (cosine.hi - slope + cosine.lo) * a.hi;
  return quick_sum(
      sum.hi, sum.lo + (small + (sine.lo + (sine.hi * t.cosine_less_1 + cosine.hi * t.sine_more))));
}

/// Returns sine and cosine of an angle (rad) of at most `kNearAngle` whose rest is good, to 61
/// bits.
inline WideSineCosine near_sine_cosine(const NearAngle& a) noexcept {
  const NearTurn t = near_turn(a);
  return {near_sine(a.step, a, t), near_sine((a.step + 32) & 127, a, t)};
}

/// Returns sine and cosine of an angle (rad) whose rest is good, wrong by less than 1.2 units in
/// the last place: by series up to 10^-17, in sums that wait little for each other.
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
