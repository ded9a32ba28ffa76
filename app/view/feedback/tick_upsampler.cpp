#include "view/feedback/tick_upsampler.h"

#include <cmath>
#include <numbers>

namespace thimble::view {

TickUpsampler::TickUpsampler(double samples_per_tick)
    : samples_per_tick_(samples_per_tick), weights_(kPhases) {
  constexpr double kHalf = kTaps / 2.0;
  for (std::size_t phase = 0; phase < kPhases; ++phase) {
    // The sample is between the two middle numbers.
    const double share = static_cast<double>(phase) / kPhases;
    double sum = 0;
    for (std::size_t i = 0; i < kTaps; ++i) {
      const double x = static_cast<double>(i) - (kHalf - 1) - share;
      const double turn = std::numbers::pi * x;
      const double sinc = std::abs(x) < 1e-9 ? 1 : std::sin(turn) / turn;
      weights_[phase][i] = sinc * 0.5 * (1 + std::cos(turn / kHalf));
      sum += weights_[phase][i];
    }
    for (double& weight : weights_[phase]) weight /= sum;  // a constant input stays constant
  }
}

void TickUpsampler::reset() {
  history_.fill(0);
}

double TickUpsampler::at(double share) const {
  const auto phase = static_cast<std::size_t>(std::lround(share * kPhases)) % kPhases;
  double sum = 0;
  for (std::size_t i = 0; i < kTaps; ++i) sum += weights_[phase][i] * history_[i];
  return sum;
}

}  // namespace thimble::view
