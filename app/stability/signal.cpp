#include "stability/signal.h"

#include <cmath>
#include <complex>
#include <numbers>

#include "math/elementary.h"

namespace thimble::stability {
namespace {

/// Applies one section of second order, by the bilinear transform of s^2 / (s^2 + s / q + 1).
void high_pass_section(std::vector<double>& signal, double warped, double q) {
  const double norm = 1 / (1 + warped / q + warped * warped);
  const double a1 = 2 * (warped * warped - 1) * norm;
  const double a2 = (1 - warped / q + warped * warped) * norm;
  double x1 = 0, x2 = 0, y1 = 0, y2 = 0;
  for (double& value : signal) {
    const double y = norm * (value - 2 * x1 + x2) - a1 * y1 - a2 * y2;
    x2 = x1;
    x1 = value;
    y2 = y1;
    y1 = y;
    value = y;
  }
}

}  // namespace

std::vector<double> high_passed(std::span<const double> signal, double rate, double corner) {
  std::vector<double> out(signal.begin(), signal.end());
  if (out.empty()) return out;
  // Starts at rest at the first value, so that an offset causes no transient.
  for (double& value : out) value -= signal.front();
  const double warped = math::tan(std::numbers::pi * corner / rate);
  for (const double angle : {std::numbers::pi / 8, 3 * std::numbers::pi / 8}) {
    high_pass_section(out, warped, 1 / (2 * math::cos(angle)));
  }
  return out;
}

double root_mean_square(std::span<const double> signal) {
  double sum = 0;
  for (const double value : signal) sum += value * value;
  return signal.empty() ? 0 : std::sqrt(sum / static_cast<double>(signal.size()));
}

double mean(std::span<const double> signal) {
  double sum = 0;
  for (const double value : signal) sum += value;
  return signal.empty() ? 0 : sum / static_cast<double>(signal.size());
}

double sign_changes_per_second(std::span<const double> signal, double rate) {
  int changes = 0;
  double last = 0;
  for (const double value : signal) {
    if (value * last < 0) ++changes;
    if (value != 0) last = value;
  }
  return signal.empty() ? 0 : changes * rate / static_cast<double>(signal.size());
}

std::vector<SpectralLine> spectrum(std::span<const double> signal, double rate) {
  const std::size_t size = signal.size();
  const double average = mean(signal);
  std::vector<SpectralLine> lines;
  for (std::size_t k = 1; 2 * k <= size; ++k) {
    const double turn = 2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(size);
    const std::complex<double> step = {math::cos(turn), -math::sin(turn)};
    std::complex<double> phase = 1;
    std::complex<double> sum = 0;
    for (const double value : signal) {
      sum += (value - average) * phase;
      phase *= step;
    }
    const double scale = (2 * k == size ? 1.0 : 2.0) / static_cast<double>(size);
    lines.push_back(
        {static_cast<double>(k) * rate / static_cast<double>(size), scale * std::abs(sum)});
  }
  return lines;
}

}  // namespace thimble::stability
