#pragma once

#include "math/sine_parts.h"
#include "thimble/driver/export.h"

namespace thimble::math {

// Functions for values that are prepared once and need more bits than a double has. Real-time:
// safe.

/// Returns e^x to 95 bits, 0 below -700; x < 700.
THIMBLE_EXPORT DoubleDouble wide_exp(DoubleDouble x) noexcept;

/// Returns e^x - 1 to 95 bits, -1 below -700; x < 700.
THIMBLE_EXPORT DoubleDouble wide_expm1(DoubleDouble x) noexcept;

/// Returns sine and cosine of an angle (rad) to 95 bits.
THIMBLE_EXPORT WideSineCosine wide_sine_cosine(DoubleDouble angle) noexcept;

}  // namespace thimble::math
