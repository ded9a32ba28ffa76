#pragma once

/// Sine, exponential and the like with the same bits on every processor and by every compiler,
/// which no C library promises: what moves an arm, a hand or an object calls these and not those of
/// <cmath> (arch.one_mathematics). Square root, rounding and remainder are exact in <cmath>
/// already.
///
/// Each result is the double nearest to the true value: it is computed to about 60 bits, and where
/// those leave open which double is nearest, to 98 or more. A wrong choice after that takes one
/// argument in 10^12 (counted against MPFR: none in 10^7). `sin_cos` alone, which every tick asks
/// for, is satisfied with less than 1.2 units in the last place. Arguments and results are those of
/// the function of <cmath> of the same name, infinities, NaN, signed zeros and denormal numbers
/// included. All functions are Real-time: safe.
namespace thimble::math {

/// A sine and the cosine of the same angle.
struct SineCosine {
  double sine = 0;    ///< Of the angle.
  double cosine = 1;  ///< Of the angle.
};

double sin(double angle) noexcept;           ///< Returns the sine of an angle (rad) of any size.
double cos(double angle) noexcept;           ///< Returns the cosine of an angle (rad) of any size.
double tan(double angle) noexcept;           ///< Returns the tangent of an angle (rad).
SineCosine sin_cos(double angle) noexcept;   ///< Returns both for less than one of them.
double asin(double sine) noexcept;           ///< Returns the angle, -pi/2 to pi/2 rad.
double acos(double cosine) noexcept;         ///< Returns the angle, 0 to pi rad.
double atan2(double y, double x) noexcept;   ///< Returns the direction of (x, y), -pi to pi rad.
double exp(double x) noexcept;               ///< Returns e^x.
double exp2(double x) noexcept;              ///< Returns 2^x.
double expm1(double x) noexcept;             ///< Returns e^x - 1, as precise near 0 as elsewhere.
double tanh(double x) noexcept;              ///< Returns the hyperbolic tangent.
double log(double x) noexcept;               ///< Returns the natural logarithm.
double pow(double base, double x) noexcept;  ///< Returns base^x; NaN for any base below 0.
double hypot(double x, double y) noexcept;   ///< Returns the length of (x, y), without overflow.
double cbrt(double x) noexcept;              ///< Returns the cube root.

}  // namespace thimble::math
