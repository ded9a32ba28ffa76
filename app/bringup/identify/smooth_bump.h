#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace thimble::bringup {

/// A smooth bump (1 - x^2)^4 over |x| < 1 with its derivatives by time (1/s, 1/s^2), at `half`
/// ticks of `dt` (s) to either side of its middle.
template <int half>
struct SmoothBump {
  std::array<double, 2 * half + 1> value{}, slope{}, curvature{};

  explicit SmoothBump(double dt) {
    const double width = half * dt;
    for (int j = -half; j <= half; ++j) {
      const double x = static_cast<double>(j) / half, y = 1 - x * x;
      const auto i = static_cast<std::size_t>(j + half);
      value[i] = y * y * y * y;
      slope[i] = -8 * x * y * y * y / width;
      curvature[i] = (-8 * y * y * y + 48 * x * x * y * y) / (width * width);
    }
  }
};

/// Weights that compute velocities (1/s) from positions, by a bump times 1 - b x^2, whose second
/// moment is zero. Where a velocity reverses, neither its slope nor the change of its slope shifts
/// the result.
template <int half>
struct TurnSmoothing {
  std::array<double, 2 * half + 1> slope{};
  double mean_distance = 0;  ///< Mean distance of a tick from the middle, s.

  explicit TurnSmoothing(double dt) {
    const SmoothBump<half> smooth(dt);
    const double width = half * dt;
    double second = 0, fourth = 0, area = 0;
    for (int j = -half; j <= half; ++j) {
      const double x2 = static_cast<double>(j * j) / (half * half);
      second += smooth.value[static_cast<std::size_t>(j + half)] * x2;
      fourth += smooth.value[static_cast<std::size_t>(j + half)] * x2 * x2;
    }
    const double b = second / fourth;
    for (int j = -half; j <= half; ++j) {
      const auto i = static_cast<std::size_t>(j + half);
      const double x = static_cast<double>(j) / half, y = 1 - b * x * x;
      slope[i] = smooth.slope[i] * y - smooth.value[i] * 2 * b * x / width;
      area += smooth.value[i] * y;
      mean_distance += smooth.value[i] * y * std::abs(j) * dt;
    }
    for (double& weight : slope) weight /= area;
    mean_distance /= area;
  }
};

}  // namespace thimble::bringup
