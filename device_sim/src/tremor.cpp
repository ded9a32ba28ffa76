#include "tremor.h"

#include <cmath>
#include <numbers>

#include "math/elementary.h"
#include "split_mix.h"

namespace thimble::device_sim {
namespace {

// Ratios without a common period, so that the pattern does not repeat within a session.
const Eigen::Vector3d kRatios{0.83, 1.0, 1.19};
// Shares of the amplitude; the middle is the strongest.
const Eigen::Vector3d kShares{0.3, 0.4, 0.3};

}  // namespace

driver::Result<Tremor> Tremor::make(const HandSettings& hand, std::uint64_t seed) {
  if (!(hand.tremor_amplitude >= 0 && hand.tremor_amplitude < HUGE_VAL)) {
    return driver::Error{
        "The tremor amplitude of the simulated hand must be finite and not negative (m)."};
  }
  if (!(hand.tremor_frequency >= 0 && hand.tremor_frequency < HUGE_VAL)) {
    return driver::Error{
        "The tremor frequency of the simulated hand must be finite and not negative (Hz)."};
  }
  return Tremor(hand, seed);
}

Tremor::Tremor(const HandSettings& hand, std::uint64_t seed)
    : angular_frequencies_(2 * std::numbers::pi * hand.tremor_frequency * kRatios),
      still_(hand.tremor_amplitude == 0) {
  SplitMix random(seed);
  for (int axis = 0; axis < 3; ++axis) {
    for (int wave = 0; wave < 3; ++wave) {
      const double phase = 2 * std::numbers::pi * random.uniform();
      // sin(w t + phase), so that one sine and cosine per frequency serve all axes.
      sines_(axis, wave) = hand.tremor_amplitude * kShares[wave] * math::cos(phase);
      cosines_(axis, wave) = hand.tremor_amplitude * kShares[wave] * math::sin(phase);
    }
  }
}

Eigen::Vector3d Tremor::at(double time) const noexcept {
  if (still_) return Eigen::Vector3d::Zero();
  Eigen::Vector3d sine, cosine;
  for (int wave = 0; wave < 3; ++wave) {
    const double angle = angular_frequencies_[wave] * time;
    const math::SineCosine both = math::sin_cos(angle);
    sine[wave] = both.sine;
    cosine[wave] = both.cosine;
  }
  return sines_ * sine + cosines_ * cosine;
}

}  // namespace thimble::device_sim
