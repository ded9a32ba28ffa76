#include "bringup/identify/line_spectrum.h"

#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <unsupported/Eigen/FFT>

#include "bringup/identify/line_forces.h"
#include "math/elementary.h"

namespace thimble::bringup {
namespace {

using Series = std::vector<double>;
using Spectrum = std::vector<std::complex<double>>;

/// The spectrum of one channel without its straight line, under Hann's window; the amplitude of a
/// sine exactly at a frequency is correct.
Spectrum spectrum(Series series) {
  const auto count = static_cast<double>(series.size());
  double sum = 0, moment = 0, square = 0;
  for (std::size_t i = 0; i < series.size(); ++i) {
    const double x = static_cast<double>(i) - 0.5 * (count - 1);
    sum += series[i];
    moment += x * series[i];
    square += x * x;
  }
  for (std::size_t i = 0; i < series.size(); ++i) {
    const double x = static_cast<double>(i) - 0.5 * (count - 1);
    const double window =
        1 - math::cos(2 * std::numbers::pi * (static_cast<double>(i) + 0.5) / count);
    series[i] = (series[i] - sum / count - moment / square * x) * window * 2 / count;
  }
  Eigen::FFT<double> transform;
  Spectrum out;
  transform.fwd(out, series);
  return out;
}

}  // namespace

LineSpectrum line_spectrum(const ArmMotion& motion) {
  LineSpectrum found;
  const auto period = static_cast<std::size_t>(std::llround(1 / (LineForces::kBase * motion.dt)));
  const std::size_t periods = motion.samples.size() / period;
  if (periods == 0) return found;
  const std::size_t count = periods * period, first = motion.samples.size() - count;
  std::array<Spectrum, 3> tau, q;
  for (int joint = 0; joint < 3; ++joint) {
    Series a(count), b(count);
    for (std::size_t i = 0; i < count; ++i) {
      const MotionSample& sample = motion.samples[first + i];
      a[i] = sample.tau[joint];
      b[i] = sample.q[joint];
    }
    tau[static_cast<std::size_t>(joint)] = spectrum(std::move(a));
    q[static_cast<std::size_t>(joint)] = spectrum(std::move(b));
  }
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Matrix3d J = motion.samples[first + i].G.inverse();
    found.JTJ += J.transpose() * J / static_cast<double>(count);
  }
  const auto at = [&](std::size_t bin) {
    SpectralLine line;
    line.omega =
        2 * std::numbers::pi * static_cast<double>(bin) / (static_cast<double>(count) * motion.dt);
    for (int joint = 0; joint < 3; ++joint) {
      line.tau[joint] = tau[static_cast<std::size_t>(joint)][bin];
      line.q[joint] = q[static_cast<std::size_t>(joint)][bin];
    }
    return line;
  };
  for (int number = 0; number < LineForces::kLines; ++number) {
    for (int axis = 0; axis < 3; ++axis) {
      const double hz = LineForces::frequency(axis, number);
      const auto bin =
          static_cast<std::size_t>(std::llround(hz * static_cast<double>(count) * motion.dt));
      found.lines.push_back(at(bin));
      // A window widens a line by one bin to either side; the next line is at least five bins away.
      for (std::size_t away = 2; away <= 5; ++away) {
        found.noise_lines.push_back(at(bin - away));
        found.noise_lines.push_back(at(bin + away));
      }
    }
  }
  return found;
}

}  // namespace thimble::bringup
