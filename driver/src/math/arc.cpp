#include <cmath>

#include "math/elementary.h"
#include "math/rough_arc.h"
#include "math/sine_parts.h"

namespace thimble::math {
namespace {

/// Error bound of an angle to 60 bits, with a bit in reserve.
constexpr double kArcDoubt = 0x1p-59;

/// Error bound of a rough angle. Its series omits u^11 / 11 and smaller terms, where u is at most
/// 1/16 and the angle at least u: 2^-43, compared with which roundings are negligible; a bit in
/// reserve.
constexpr double kRoughDoubt = 0x1p-42;

/// The angle of (x, y) to 42 bits; at least one of them is not 0.
double rough_arc(double y, double x) noexcept {
  const double up = std::abs(y), along = std::abs(x);
  const bool steep = up > along;
  const double slope = steep ? along / up : up / along;
  const double eighths = (8 * slope + kWhole) - kWhole;
  // atan(s) = atan(c) + atan((s - c) / (1 + s c))
  const double u = (slope - eighths / 8) / (1 + slope * (eighths / 8));
  const double u2 = u * u;
  const double series = u2 * (-1. / 3 + u2 * (1. / 5 + u2 * (-1. / 7 + u2 * (1. / 9))));
  double arc = kArcs[static_cast<int>(eighths)] + (u + u * series);
  if (steep) arc = kHalfPi.hi - arc;
  if (x < 0) arc = kPi.hi - arc;
  return y < 0 ? -arc : arc;
}

/// The angle of (x, y); the greater of the two is between 2^-30 and 2, and their ratio above 2^-61.
/// It is a rough angle plus the difference, which is so small that it equals its tangent.
double arc_of(DoubleDouble y, DoubleDouble x) noexcept {
  const double rough = rough_arc(y.hi, x.hi);
  const NearAngle near = near_angle(rough);
  if (near.good) {
    const auto [s, c] = near_sine_cosine(near);
    const DoubleDouble yc = exact_product(y.hi, c.hi), xs = exact_product(x.hi, s.hi);
    const double rest =
        (yc.lo - xs.lo) + ((y.hi * c.lo - x.hi * s.lo) + (y.lo * c.hi - x.lo * s.hi));
    const double more = ((yc.hi - xs.hi) + rest) / (x.hi * c.hi + y.hi * s.hi);
    const double wrong = kArcDoubt * rough;
    if (rough + (more - wrong) == rough + (more + wrong)) return rough + more;
  }
  const auto [s, c] = wide_sine_cosine(rough);
  const DoubleDouble more = (y * c - x * s) / (x * c + y * s);
  return (more + rough).hi;
}

/// 2^-exponent for 2^exponent <= |a| < 2^(exponent + 1), |a| normal.
double inverse_power(double a) noexcept {
  return std::bit_cast<double>((std::uint64_t{2046} << 52) -
                               (std::bit_cast<std::uint64_t>(a) & std::uint64_t{2047} << 52));
}

/// The square root of 1 - a^2, |a| < 1.
DoubleDouble beside(double a) noexcept {
  const DoubleDouble square = exact_product(a, a);
  const DoubleDouble most = exact_sum(1, -square.hi);
  return square_root(quick_sum(most.hi, most.lo - square.lo));
}

}  // namespace

double atan2(double y, double x) noexcept {
  if (std::isnan(x) || std::isnan(y)) return x + y;
  if (std::isinf(x)) {
    // The diagonal if both are infinite.
    x = std::copysign(std::isinf(y) ? 1 : 0x1p100, x);
    y = std::isinf(y) ? std::copysign(1, y) : std::copysign(0x1p-1022, y);
    if (x == 0x1p100) return std::copysign(0, y);
  } else if (std::isinf(y)) {
    return std::copysign(kHalfPi.hi, y);
  }
  const double up = std::abs(y), along = std::abs(x);
  if (up == 0 && along == 0) return std::copysign(std::signbit(x) ? kPi.hi : 0, y);
  const bool steep = up > along;
  double most = steep ? up : along;
  if ((steep ? along : up) <= most * 0x1p-60) {
    // Close to an axis an angle equals its tangent.
    if (!steep && !std::signbit(x)) return y / x;
    const DoubleDouble axis = steep ? kHalfPi : kPi;
    const double away = steep ? x / up : up / along;
    return std::copysign((axis + -away).hi, y);
  }
  // Scaled so that powers are in range and products are exact.
  const double nearer = most > 1 ? 0x1p-200 : 0x1p200;
  if (!(most > 0x1p-800 && most < 0x1p800)) {
    most *= nearer;
    x *= nearer;
    y *= nearer;
  }
  const double power = inverse_power(most);
  return arc_of({y * power, 0}, {x * power, 0});
}

RoughAngle rough_atan2(double y, double x) noexcept {
  const double up = std::abs(y), along = std::abs(x);
  const double least = up > along ? along : up, most = up > along ? up : along;
  // Close to an axis the ratio may be denormal; for very large or small numbers rounding errors are
  // not relative.
  if (!(most < 0x1p1000 && least > most * 0x1p-60 && most > 0x1p-900)) {
    return {.angle = 0, .wrong = HUGE_VAL};
  }
  const double angle = rough_arc(y, x);
  return {.angle = angle, .wrong = kRoughDoubt * std::abs(angle)};
}

double asin(double sine) noexcept {
  const double size = std::abs(sine);
  if (!(size < 1)) return size == 1 ? sine * kHalfPi.hi : (sine - sine) / (sine - sine);
  if (size <= 0x1p-26) return sine;  // sine^3 / 6 is below half of its last place
  return arc_of({sine, 0}, beside(sine));
}

double acos(double cosine) noexcept {
  const double size = std::abs(cosine);
  if (!(size < 1)) {
    if (size == 1) return cosine > 0 ? 0 : kPi.hi;
    return (cosine - cosine) / (cosine - cosine);
  }
  if (size <= 0x1p-60) return (kHalfPi + -cosine).hi;
  return arc_of(beside(cosine), {cosine, 0});
}

}  // namespace thimble::math
