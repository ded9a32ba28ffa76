#pragma once

#include <cmath>

namespace thimble::studies {

/// Where a mass is (m) and how fast (m/s), along one line.
struct LineMotion {
  double x = 0, v = 0;
};

/// Returns the exact way of a mass (kg) with viscous friction (N s/m, above 0) under a force (N)
/// that is held for `time` s. Real-time: safe.
inline LineMotion moved_by_held_force(const LineMotion& at, double mass, double viscous,
                                      double force, double time) noexcept {
  const double rate = viscous / mass;
  const double end = force / viscous;  // m/s, towards which it goes
  const double fade = -std::expm1(-rate * time);
  return {at.x + end * time + (at.v - end) * fade / rate, at.v + (end - at.v) * fade};
}

}  // namespace thimble::studies
