#pragma once

#include <algorithm>

#include "bringup/identify/weak_form/motion_equations.h"

namespace thimble::bringup {

/// Returns a coarse minimum of `residual_at(delay)`, s, in steps of half a millisecond.
template <class Residual>
double coarse_delay(const Residual& residual_at) {
  double best = 0, lowest = residual_at(0.0);
  for (double delay = 0.0005; delay < MotionEquations::kDelayMax; delay += 0.0005) {
    const double rest = residual_at(delay);
    if (rest < lowest) lowest = rest, best = delay;
  }
  return best;
}

/// Returns the minimum of `residual_at(delay)` within half a millisecond of a delay (s) by golden
/// sections, to `within` (s).
template <class Residual>
double refined_delay(double about, double within, const Residual& residual_at) {
  constexpr double kGolden = 0.6180339887498949;
  double low = std::max(0.0, about - 0.0005), high = about + 0.0005;
  double left = high - kGolden * (high - low), right = low + kGolden * (high - low);
  double at_left = residual_at(left), at_right = residual_at(right);
  while (high - low > within) {
    if (at_left < at_right) {
      high = right, right = left, at_right = at_left;
      at_left = residual_at(left = high - kGolden * (high - low));
    } else {
      low = left, left = right, at_left = at_right;
      at_right = residual_at(right = low + kGolden * (high - low));
    }
  }
  return 0.5 * (low + high);
}

}  // namespace thimble::bringup
