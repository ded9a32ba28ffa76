#pragma once

#include "thimble/driver/export.h"

namespace thimble::math {

/// An angle and the bound of its error.
struct RoughAngle {
  double angle = 0;  ///< rad
  double wrong = 0;  ///< Max. error, rad; infinite if nothing is known.
};

/// Returns the direction of (x, y) to 42 bits in a fifth of the time of `atan2`. For callers that
/// need fewer bits and call `atan2` only if these do not decide. Bit-identical on every processor.
/// Nothing is known within 2^-60 rad of an axis, and where a number is not finite or out of 2^-900
/// to 2^1000. Real-time: safe.
THIMBLE_EXPORT RoughAngle rough_atan2(double y, double x) noexcept;

}  // namespace thimble::math
