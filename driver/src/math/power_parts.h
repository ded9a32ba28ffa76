#pragma once

#include <bit>
#include <cstdint>

#include "math/double_double.h"
#include "math/tables.h"

namespace thimble::math {

/// Returns 2^exponent, for a normal number.
inline double power_of_2(std::int64_t exponent) noexcept {
  return std::bit_cast<double>(static_cast<std::uint64_t>(exponent + 1023) << 52);
}

/// e^x as (1 + more) * table * 2^exponent.
struct WidePower {
  DoubleDouble table;  ///< 2^(i / 64), 1 to 2.
  DoubleDouble more;   ///< e^rest - 1 of a rest below ln(2) / 128, to 100 bits.
  std::int64_t exponent = 0;
};

/// Returns the parts of e^x, |x| < 800; `x` is accurate to 2^-100.
WidePower wide_power(DoubleDouble x) noexcept;

/// Returns (1 + more) * table * 2^exponent with one rounding: infinite if it is too large, denormal
/// or 0 if it is too small.
double rounded(const WidePower& power) noexcept;

}  // namespace thimble::math
