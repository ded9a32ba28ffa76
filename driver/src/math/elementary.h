#pragma once

#include "thimble/driver/export.h"

/// Sine, exponential and other functions, bit-identical on every processor and with every compiler.
/// No C library promises that. Code that moves an arm, a hand or an object calls these and not
/// those of <cmath> (arch.one_mathematics). Square root, rounding and remainder are exact in
/// <cmath> already.
///
/// Each result is the double nearest to the true value. It is computed to about 60 bits and, where
/// those do not decide which double is nearest, to 98 or more. A wrong choice after that takes one
/// argument in 10^12 (counted against MPFR: none in 10^7). Only `sin_cos`, which every tick calls,
/// allows an error, below 1.2 units in the last place. Arguments and results are those of the
/// function of <cmath> of the same name, including infinities, NaN, signed zeros and denormal
/// numbers. All functions are Real-time: safe.
namespace thimble::math {

/// Sine and cosine of one angle.
struct SineCosine {
  double sine = 0;    ///< Sine of the angle.
  double cosine = 1;  ///< Cosine of the angle.
};

/// Returns the sine of an angle (rad) of any size.
THIMBLE_EXPORT double sin(double angle) noexcept;
/// Returns the cosine of an angle (rad) of any size.
THIMBLE_EXPORT double cos(double angle) noexcept;
/// Returns the tangent of an angle (rad).
THIMBLE_EXPORT double tan(double angle) noexcept;
/// Returns both, in less time than one of them takes.
THIMBLE_EXPORT SineCosine sin_cos(double angle) noexcept;
/// Returns the arc sine, -pi/2 to pi/2 rad.
THIMBLE_EXPORT double asin(double sine) noexcept;
/// Returns the arc cosine, 0 to pi rad.
THIMBLE_EXPORT double acos(double cosine) noexcept;
/// Returns the direction of (x, y), -pi to pi rad.
THIMBLE_EXPORT double atan2(double y, double x) noexcept;
/// Returns e^x.
THIMBLE_EXPORT double exp(double x) noexcept;
/// Returns 2^x.
THIMBLE_EXPORT double exp2(double x) noexcept;
/// Returns e^x - 1, with the same relative precision near 0 as elsewhere.
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
