#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "thimble/device_sim/settings.h"
#include "thimble/driver/result.h"

namespace thimble::device_sim {

/// The physiological tremor of a hand: per axis a sum of three sines around its middle
/// frequency, whose amplitudes add up to the asked one. A hand's tremor is at 8 to 12 Hz [guess,
/// from the general literature; amplitude and frequency are data]; the ratios cover that band
/// around 10 Hz.
class Tremor {
 public:
  /// Makes a tremor whose phases are drawn from `seed`, alike on every machine. Fails if amplitude
  /// or frequency is negative or not finite. Real-time: never from the servo thread.
  static driver::Result<Tremor> make(const HandSettings& hand, std::uint64_t seed);

  /// Finds the displacement (m) at a time (s); exactly zero if the amplitude is. Real-time: safe.
  Eigen::Vector3d at(double time) const noexcept;

 private:
  Tremor(const HandSettings& hand, std::uint64_t seed);

  Eigen::Vector3d angular_frequencies_;  // of the three sines, rad/s
  Eigen::Matrix3d sines_, cosines_;      // amplitudes, m: row axis, column frequency
  bool still_;
};

}  // namespace thimble::device_sim
