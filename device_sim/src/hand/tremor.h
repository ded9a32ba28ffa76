#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "thimble/device_sim/settings.h"
#include "thimble/driver/result.h"

namespace thimble::device_sim {

/// The physiological tremor of a hand: per axis a sum of three sines around its middle frequency,
/// whose amplitudes add up to the given one. A hand's tremor is at 8 to 12 Hz [guess, from the
/// general literature; amplitude and frequency are data]. The frequency ratios cover that band
/// around 10 Hz.
class Tremor {
 public:
  /// Makes a tremor whose phases are drawn from `seed`, identical on every machine. Fails if
  /// amplitude or frequency is negative or not finite. Real-time: never from the servo thread.
  static driver::Result<Tremor> make(const HandSettings& hand, std::uint64_t seed);

  /// Returns the displacement (m) at a time (ns); exactly zero if the amplitude is. Fastest if time
  /// advances in equal steps, as in a servo loop. The sines are then rotated by the angle of a step
  /// and recomputed every kTurns steps, which keeps them accurate to 1e-12 of the amplitude.
  /// Real-time: safe.
  Eigen::Vector3d at(std::int64_t time_ns) noexcept;

 private:
  /// Max. number of rotations of the sines between computations: each rounds them by up to about
  /// 1e-16.
  static constexpr int kTurns = 1000;

  Tremor(const HandSettings& hand, std::uint64_t seed);
  void turn() noexcept;
  void compute(std::int64_t step_ns) noexcept;

  Eigen::Vector3d angular_frequencies_;  // of the three sines, rad/s
  Eigen::Matrix3d sines_, cosines_;      // amplitudes, m: row axis, column frequency
  bool still_;

  std::int64_t time_ns_ = 0;
  std::int64_t step_ns_ = 0;                                   // last step, ns
  int turns_left_ = 0;                                         // 0: the angle of a step is unknown
  Eigen::Vector3d sine_{0, 0, 0}, cosine_{1, 1, 1};            // at time_ns_
  Eigen::Vector3d step_sine_{0, 0, 0}, step_cosine_{1, 1, 1};  // of the angle of a step
};

}  // namespace thimble::device_sim
