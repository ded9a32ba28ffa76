#pragma once

#include "thimble/driver/export.h"

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

/// Returns the sine of an angle (rad) of any size.
THIMBLE_EXPORT double sin(double angle) noexcept;
/// Returns the cosine of an angle (rad) of any size.
THIMBLE_EXPORT double cos(double angle) noexcept;
/// Returns the tangent of an angle (rad).
THIMBLE_EXPORT double tan(double angle) noexcept;
/// Returns both for less than one of them.
THIMBLE_EXPORT SineCosine sin_cos(double angle) noexcept;
/// Returns the angle, -pi/2 to pi/2 rad.
THIMBLE_EXPORT double asin(double sine) noexcept;
/// Returns the angle, 0 to pi rad.
THIMBLE_EXPORT double acos(double cosine) noexcept;
/// Returns the direction of (x, y), -pi to pi rad.
THIMBLE_EXPORT double atan2(double y, double x) noexcept;
/// Returns e^x.
THIMBLE_EXPORT double exp(double x) noexcept;
/// Returns 2^x.
THIMBLE_EXPORT double exp2(double x) noexcept;
/// Returns e^x - 1, as precise near 0 as elsewhere.
THIMBLE_EXPORT double expm1(double x) noexcept;
/// Returns the hyperbolic tangent.
THIMBLE_EXPORT double tanh(double x) noexcept;
/// Returns the natural logarithm.
THIMBLE_EXPORT double log(double x) noexcept;
/// Returns base^x; NaN for any base below 0.
THIMBLE_EXPORT double pow(double base, double x) noexcept;
/// Returns the length of (x, y), without overflow.
THIMBLE_EXPORT double hypot(double x, double y) noexcept;
/// Returns the cube root.
THIMBLE_EXPORT double cbrt(double x) noexcept;

}  // namespace thimble::math
