#pragma once

namespace thimble::studies {

/// A hand's motion along one line, known in closed form: a slow stroke, a faster one, and tremor.
/// Real-time: never from the servo thread.
struct HandSignal {
  double x = 0;  ///< m
  double v = 0;  ///< m/s
};

/// Returns the position of the hand at `t` s: 20 mm at 0.4 Hz, 1 mm at 3 Hz, 50 um at 10 Hz.
HandSignal hand_signal(double t);

/// Rounds `x` to whole steps of an encoder; 0 leaves it unchanged.
double counted(double x, double step);

}  // namespace thimble::studies
