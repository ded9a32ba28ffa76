#pragma once

#include "thimble/driver/export.h"

namespace thimble::scene {

// Functions for the gate of an arm from the laws in stability/stability_laws.h, with the same
// symbols. Real-time: none of these functions may be called from the servo thread.

/// Delays of a loop [PHYSICS 1.1].
struct LoopTimes {
  double period = 0.001;     ///< Mean time between ticks, s.
  double period_spread = 0;  ///< Standard deviation of that time, s.
  /// Delay from sampling the encoders to the motors in addition to the hold, s.
  double delay = 0;
  double amplifier_lag = 0;  ///< First-order lag of motors and amplifiers, s.
  double position_lag = 0;   ///< Lag of a low-pass on the position, s (see low_pass_lag).
};

/// Returns the latency L = E[T^2] / (2 E[T]) + delays + lags, s [PHYSICS 1.1].
THIMBLE_EXPORT double latency_of(const LoopTimes& times);

/// Returns the lag (s) of a one-pole low-pass of corner frequency `corner` (Hz) at `period` (s): T
/// (1 - a) / a with a = 1 - exp(-2 pi corner T). A corner of 0 means no filter and no lag.
double low_pass_lag(double corner, double period);

/// Returns the stiffness up to which a free device is stable, (b + B) / L, N/m [PHYSICS 1.1].
/// `damping` is b + B, N s/m. Valid for (b + B) T / m up to 0.1; for larger values see
/// `stiffness_edge`.
THIMBLE_EXPORT double stiffness_limit(double damping, double latency);

}  // namespace thimble::scene
