#include "bringup/identify/excitation.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "math/elementary.h"

namespace thimble::bringup {
namespace {

constexpr double kAmplitude = 0.11;             // of each sine, as a share of the allowed force
constexpr double kLowest = 0.7, kHighest = 13;  // Hz

}  // namespace

Excitation::Excitation(const Eigen::Vector3d& p_WM, std::uint64_t seed, Lines lines, double allowed)
    : hold_(p_WM), lines_(seed + 1), with_lines_(lines == Lines::kWith), allowed_(allowed) {
  std::mt19937_64 bits(seed);
  const double steps = 3 * kSines - 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < kSines; ++i) {
      // All frequencies differ, evenly spaced in their logarithm, with the axes in turn.
      const double share = static_cast<double>(3 * i + axis) / steps;
      frequency_[axis][i] = 2 * std::numbers::pi * kLowest * math::pow(kHighest / kLowest, share);
      phase_[axis][i] = 2 * std::numbers::pi * 0x1p-53 * static_cast<double>(bits() >> 11);
    }
  }
}

Eigen::Vector3d Excitation::force(double time, double dt, const Eigen::Vector3d& p_WT,
                                  const Eigen::Vector3d& v_WT) noexcept {
  if (!near(p_WT)) return {0, 0, 0};
  // The sines fade from a quarter of the distance on; from two thirds on only the spring remains.
  const double share = std::clamp(1.6 - 2.4 * (p_WT - hold_.place()).norm() / kFar, 0.0, 1.0);
  Eigen::Vector3d f = hold_.force(dt, p_WT, v_WT);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < kSines; ++i) {
      f[static_cast<Eigen::Index>(axis)] +=
          share * kAmplitude * allowed_ * math::sin(frequency_[axis][i] * time + phase_[axis][i]);
    }
  }
  if (with_lines_) f += share * allowed_ * lines_.force(time);
  const double length = f.norm(), limit = max_force();
  if (!(length > limit)) return f;
  return f * (limit / length);
}

}  // namespace thimble::bringup
