#include "hand/tremor.h"

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
      // sin(w t + phase), so that all axes share one sine and cosine per frequency.
      sines_(axis, wave) = hand.tremor_amplitude * kShares[wave] * math::cos(phase);
      cosines_(axis, wave) = hand.tremor_amplitude * kShares[wave] * math::sin(phase);
    }
  }
}

Eigen::Vector3d Tremor::at(std::int64_t time_ns) noexcept {
  if (still_) return Eigen::Vector3d::Zero();
  if (time_ns != time_ns_) {
    const std::int64_t step_ns = time_ns - time_ns_;
    time_ns_ = time_ns;
    if (step_ns == step_ns_ && turns_left_ > 0) {
      turn();
    } else {
      compute(step_ns);
    }
  }
  return sines_ * sine_ + cosines_ * cosine_;
}

void Tremor::turn() noexcept {
  const Eigen::Vector3d sine = sine_.cwiseProduct(step_cosine_) + cosine_.cwiseProduct(step_sine_);
  cosine_ = cosine_.cwiseProduct(step_cosine_) - sine_.cwiseProduct(step_sine_);
  sine_ = sine;
  --turns_left_;
}

// The angle of a step is only computed if the step repeats.
void Tremor::compute(std::int64_t step_ns) noexcept {
  const bool again = step_ns == step_ns_;
  step_ns_ = step_ns;
  turns_left_ = again ? kTurns : 0;
  for (int wave = 0; wave < 3; ++wave) {
    const double w = angular_frequencies_[wave];
    const math::SineCosine now = math::sin_cos(w * (static_cast<double>(time_ns_) * 1e-9));
    sine_[wave] = now.sine;
    cosine_[wave] = now.cosine;
    if (!again) continue;
    const math::SineCosine step = math::sin_cos(w * (static_cast<double>(step_ns) * 1e-9));
    step_sine_[wave] = step.sine;
    step_cosine_[wave] = step.cosine;
  }
}

}  // namespace thimble::device_sim
