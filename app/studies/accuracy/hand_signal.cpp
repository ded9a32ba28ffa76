#include "studies/accuracy/hand_signal.h"

#include <cmath>
#include <numbers>

namespace thimble::studies {

HandSignal hand_signal(double t) {
  struct Wave {
    double amplitude, frequency, phase;
  };
  // Frequencies without a common period, so that positions cover the range between two counts.
  constexpr Wave kWaves[] = {{0.02, 0.4142, 0.3}, {0.001, 3.1416, 1.1}, {50e-6, 10.36, 2.0}};
  HandSignal at;
  for (const Wave& wave : kWaves) {
    const double rate = 2 * std::numbers::pi * wave.frequency;
    at.x += wave.amplitude * std::sin(rate * t + wave.phase);
    at.v += wave.amplitude * rate * std::cos(rate * t + wave.phase);
  }
  return at;
}

double counted(double x, double step) {
  return step > 0 ? step * std::round(x / step) : x;
}

}  // namespace thimble::studies
