#pragma once

#include <cfloat>
#include <cmath>

#if defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__)
#error \
    "-ffast-math and its parts: forces would have other bits than those that the tests store, and a force that is no number might pass as one. Leave them out."
#endif
#if !defined(FLT_EVAL_METHOD) || FLT_EVAL_METHOD != 0
#error \
    "This compiler computes with more bits than a number has (x87): forces would have other bits than those that the tests store. Build for 64 bits, or with -msse2 -mfpmath=sse."
#endif
#if defined(__x86_64__) && defined(__SSE3__)
#error \
    "-march, -mavx or the like: Eigen would add in another order and fuse products with sums, and forces would have other bits than those that the tests store. Leave them out."
#endif

namespace thimble::math {

/// A number as the sum of two doubles, 106 bits. The second is at most half a unit in the last
/// place of the first. All functions are Real-time: safe, and use no fused multiply-add, so that
/// every processor computes the same. Sums and products after [Dekker] and [Knuth].
struct DoubleDouble {
  double hi;  ///< The number, rounded.
  double lo;  ///< The rounding error.

  constexpr DoubleDouble(double a = 0, double rest = 0) noexcept : hi(a), lo(rest) {}  // NOLINT
};

/// Returns a + b exactly, where |a| >= |b| or a = 0.
inline DoubleDouble quick_sum(double a, double b) noexcept {
  const double sum = a + b;
  return {sum, b - (sum - a)};
}

/// Returns a + b exactly.
inline DoubleDouble exact_sum(double a, double b) noexcept {
  const double sum = a + b;
  const double of_b = sum - a;
  return {sum, (a - (sum - of_b)) + (b - of_b)};
}

/// Returns the upper 26 bits of a; the remainder has 26 as well. |a| < 2^996.
inline double upper_half(double a) noexcept {
  const double shifted = 134217729 * a;  // 2^27 + 1
  return shifted - (shifted - a);
}

/// Returns a b exactly, where no part of it is too large or too small for a double.
inline DoubleDouble exact_product(double a, double b) noexcept {
  const double product = a * b;
  const double a_hi = upper_half(a), b_hi = upper_half(b);
  const double a_lo = a - a_hi, b_lo = b - b_hi;
  return {product, ((a_hi * b_hi - product) + a_hi * b_lo + a_lo * b_hi) + a_lo * b_lo};
}

inline DoubleDouble operator-(DoubleDouble a) noexcept {
  return {-a.hi, -a.lo};
}

inline DoubleDouble operator+(DoubleDouble a, DoubleDouble b) noexcept {
  DoubleDouble sum = exact_sum(a.hi, b.hi);
  const DoubleDouble rest = exact_sum(a.lo, b.lo);
  sum = quick_sum(sum.hi, sum.lo + rest.hi);
  return quick_sum(sum.hi, sum.lo + rest.lo);
}

inline DoubleDouble operator+(DoubleDouble a, double b) noexcept {
  const DoubleDouble sum = exact_sum(a.hi, b);
  return quick_sum(sum.hi, sum.lo + a.lo);
}

inline DoubleDouble operator-(DoubleDouble a, DoubleDouble b) noexcept {
  return a + -b;
}

inline DoubleDouble operator*(DoubleDouble a, DoubleDouble b) noexcept {
  const DoubleDouble product = exact_product(a.hi, b.hi);
  return quick_sum(product.hi, product.lo + (a.hi * b.lo + a.lo * b.hi));
}

inline DoubleDouble operator*(DoubleDouble a, double b) noexcept {
  const DoubleDouble product = exact_product(a.hi, b);
  return quick_sum(product.hi, product.lo + a.lo * b);
}

inline DoubleDouble operator/(DoubleDouble a, DoubleDouble b) noexcept {
  const double first = a.hi / b.hi;
  DoubleDouble rest = a - b * first;
  const double second = rest.hi / b.hi;
  rest = rest - b * second;
  return quick_sum(first, second) + rest.hi / b.hi;
}

/// Returns the square root of a > 0.
inline DoubleDouble square_root(DoubleDouble a) noexcept {
  const double root = std::sqrt(a.hi);
  return quick_sum(root, (a - exact_product(root, root)).hi / (2 * root));
}

/// Returns a times a power of two.
inline DoubleDouble scaled(DoubleDouble a, double power) noexcept {
  return {a.hi * power, a.lo * power};
}

}  // namespace thimble::math
