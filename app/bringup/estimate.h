#pragma once

#include <cmath>

namespace thimble::bringup {

/// Half-width of the 95 % interval of a normal distribution, in standard deviations.
inline constexpr double kNormal95 = 1.96;

/// A constant with the half-width of its 95 % interval, in the same unit.
struct Estimate {
  double value = 0;
  double plus_minus = 0;

  /// Returns whether a value lies inside the interval.
  bool holds(double truth) const { return std::abs(truth - value) <= plus_minus; }
};

}  // namespace thimble::bringup
