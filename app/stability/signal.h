#pragma once

#include <span>
#include <vector>

namespace thimble::stability {

// Measures of sampled signals for studies. Real-time: never from the servo thread.

/// Applies a Butterworth high-pass of fourth order at `corner` (Hz), `rate` (Hz).
std::vector<double> high_passed(std::span<const double> signal, double rate, double corner);

/// Returns the root of the mean square; 0 for an empty signal.
double root_mean_square(std::span<const double> signal);

/// Returns the mean; 0 for an empty signal.
double mean(std::span<const double> signal);

/// Returns the number of sign changes per second; zeros count as the sign before.
double sign_changes_per_second(std::span<const double> signal, double rate);

/// One line of a spectrum.
struct SpectralLine {
  double frequency = 0;  ///< Hz
  double amplitude = 0;  ///< Peak, in the signal's unit.
};

/// Returns the amplitudes from the first line above 0 to half the rate, without the mean and
/// without a window.
std::vector<SpectralLine> spectrum(std::span<const double> signal, double rate);

}  // namespace thimble::stability
