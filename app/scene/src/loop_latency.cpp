#include "loop_latency.h"

#include <cmath>
#include <numbers>

#include "math/elementary.h"

namespace thimble::scene {

double latency_of(const LoopTimes& times) {
  const double mean_square =
      times.period * times.period + times.period_spread * times.period_spread;
  return mean_square / (2 * times.period) + times.delay + times.amplifier_lag + times.position_lag;
}

double low_pass_lag(double corner, double period) {
  if (corner == 0) return 0;
  const double gain = -math::expm1(-2 * std::numbers::pi * corner * period);
  return period * (1 - gain) / gain;
}

double stiffness_limit(double damping, double latency) {
  return damping / latency;
}

}  // namespace thimble::scene
