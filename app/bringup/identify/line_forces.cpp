#include "bringup/identify/line_forces.h"

#include <cmath>
#include <numbers>
#include <random>

#include "math/elementary.h"

namespace thimble::bringup {
namespace {

// N; inertia reduces the motion with the square of the frequency, so the force grows accordingly.
constexpr double kLineAmplitude = 0.025;  // of the lowest line

}  // namespace

LineForces::LineForces(std::uint64_t seed) {
  std::mt19937_64 bits(seed);
  for (auto& axis : phase_) {
    for (double& phase : axis) {
      phase = 2 * std::numbers::pi * 0x1p-53 * static_cast<double>(bits() >> 11);
    }
  }
}

double LineForces::frequency(int axis, int line) noexcept {
  // Evenly spaced in their logarithm, the axes in turn, each at the next odd multiple.
  const double share = static_cast<double>(3 * line + axis) / (3 * kLines - 1);
  const double wanted = kLowest * math::pow(kHighest / kLowest, share);
  return kBase * (2 * std::floor(wanted / (2 * kBase)) + 1);
}

Eigen::Vector3d LineForces::force(double time) const noexcept {
  Eigen::Vector3d f(0, 0, 0);
  for (int axis = 0; axis < 3; ++axis) {
    for (int line = 0; line < kLines; ++line) {
      const double hz = frequency(axis, line);
      f[axis] += kLineAmplitude * std::sqrt(hz / kLowest) *
                 math::sin(2 * std::numbers::pi * hz * time +
                           phase_[static_cast<std::size_t>(axis)][static_cast<std::size_t>(line)]);
    }
  }
  return f;
}

}  // namespace thimble::bringup
