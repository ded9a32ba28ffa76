#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace thimble::view {

/// Computes audio samples from numbers that arrive once a tick, without adding frequencies: a
/// windowed sinc of 16 ticks (Hann window). The delay is 8 ticks. Real-time: never from the servo
/// thread.
class TickUpsampler {
 public:
  static constexpr std::size_t kTaps = 16;
  /// Positions of samples between two ticks. They are exact for tick rates from 1 to 8 kHz whose
  /// period is a whole number of samples, or of tenths of one.
  static constexpr std::size_t kPhases = 480;

  /// `samples_per_tick`: greater than 0.
  explicit TickUpsampler(double samples_per_tick);

  /// Forgets all previous numbers.
  void reset();

  /// Takes the next number and calls `each(sample)` for every sample before the next number.
  template <class Each>
  void take(double x, Each each) {
    for (std::size_t i = 0; i + 1 < kTaps; ++i) history_[i] = history_[i + 1];
    history_.back() = x;
    for (; place_ < samples_per_tick_ - 1e-9; place_ += 1) each(at(place_ / samples_per_tick_));
    place_ -= samples_per_tick_;
  }

 private:
  double at(double share) const;

  double samples_per_tick_;
  double place_ = 0;  // position of the next sample after the newest tick, samples
  std::array<double, kTaps> history_{};
  std::vector<std::array<double, kTaps>> weights_;  // one array per phase
};

}  // namespace thimble::view
