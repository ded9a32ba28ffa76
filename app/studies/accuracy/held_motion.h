#pragma once

#include <cmath>

namespace thimble::studies {

/// Position (m) and speed (m/s) of a mass along one line.
struct LineMotion {
  double x = 0, v = 0;
};

/// Returns the exact motion of a mass (kg) with viscous friction (N s/m, above 0) under a constant
/// force (N) for `time` s. Real-time: safe.
inline LineMotion moved_by_held_force(const LineMotion& at, double mass, double viscous,
                                      double force, double time) noexcept {
  const double rate = viscous / mass;
  const double end = force / viscous;  // m/s, terminal speed
  const double fade = -std::expm1(-rate * time);
  return {at.x + end * time + (at.v - end) * fade / rate, at.v + (end - at.v) * fade};
}

}  // namespace thimble::studies
