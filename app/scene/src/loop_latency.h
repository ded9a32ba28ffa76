#pragma once

#include "thimble/driver/export.h"

namespace thimble::scene {

// What the gate of an arm needs of the laws in stability/stability_laws.h. Letters as there.
// Real-time: never from the servo thread.

/// What delays a loop's answer [PHYSICS 1.1].
struct LoopTimes {
  double period = 0.001;     ///< Mean time between ticks, s.
  double period_spread = 0;  ///< Standard deviation of that time, s.
  double delay = 0;          ///< From sampling the encoders to the motors, beyond the hold, s.
  double amplifier_lag = 0;  ///< First-order lag of motors and amplifiers, s.
  double position_lag = 0;   ///< Of a low-pass on the position, s (see low_pass_lag).
};

/// Sums up the latency budget L = E[T^2] / (2 E[T]) + delays + lags, s [PHYSICS 1.1].
THIMBLE_EXPORT double latency_of(const LoopTimes& times);

/// Finds the lag of a one-pole low-pass of corner frequency `corner` (Hz) at `period` (s):
/// T (1 - a) / a with a = 1 - exp(-2 pi corner T). A corner of 0 means no filter and no lag.
double low_pass_lag(double corner, double period);

/// Finds the stiffness up to which a free device is stable, (b + B) / L, N/m [PHYSICS 1.1].
/// `damping` is b + B, N s/m. Holds for (b + B) T / m up to 0.1; beyond, see `stiffness_edge`.
THIMBLE_EXPORT double stiffness_limit(double damping, double latency);

}  // namespace thimble::scene
