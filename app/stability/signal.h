#pragma once

#include <span>
#include <vector>

namespace thimble::stability {

// What studies measure in sampled signals. Real-time: never from the servo thread.

/// Takes away what is slow: Butterworth's high-pass of fourth order at `corner` (Hz), `rate` (Hz).
std::vector<double> high_passed(std::span<const double> signal, double rate, double corner);

/// Returns the root of the mean square; 0 of nothing.
double root_mean_square(std::span<const double> signal);

/// Returns the mean; 0 of nothing.
double mean(std::span<const double> signal);

/// Returns how often per second the sign changes; zeros count as the sign before.
double sign_changes_per_second(std::span<const double> signal, double rate);

/// One line of a spectrum.
struct SpectralLine {
  double frequency = 0;  ///< Hz
  double amplitude = 0;  ///< Peak, in the signal's unit.
};

/// Finds the amplitudes from one line above 0 up to half the rate, mean taken away, no window.
std::vector<SpectralLine> spectrum(std::span<const double> signal, double rate);

}  // namespace thimble::stability
