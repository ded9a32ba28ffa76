#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace thimble::view {

/// Makes audio samples of numbers that come once a tick, without what was not in them: a sinc of
/// 16 ticks under a Hann window. It delays by 8 ticks. Real-time: never from the servo thread.
class TickUpsampler {
 public:
  static constexpr std::size_t kTaps = 16;
  /// Places between two ticks at which samples lie; of every rate of ticks from 1 to 8 kHz whose
  /// period is a whole number of samples, or of a tenth of one, they lie there exactly.
  static constexpr std::size_t kPhases = 480;

  /// `samples_per_tick`: above 0.
  explicit TickUpsampler(double samples_per_tick);

  /// Forgets what came.
  void reset();

  /// Takes the next number and calls `each(sample)` for every sample until the one after it.
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
  double place_ = 0;  // of the next sample after the newest tick, samples
  std::array<double, kTaps> history_{};
  std::vector<std::array<double, kTaps>> weights_;  // of each phase
};

}  // namespace thimble::view
