#pragma once

#include <array>
#include <memory>

namespace thimble::studies {

/// Estimates the velocity along one line from encoder positions: the product's estimator and others
/// for comparison. Real-time: safe, after construction.
class VelocityEstimate {
 public:
  virtual ~VelocityEstimate() = default;
  /// Takes the next position (m) and returns the velocity, m/s.
  virtual double update(double x) noexcept = 0;
};

/// Makes the product's estimator: backward difference and a pole at `corner` Hz (0: none), every
/// `period` s.
std::unique_ptr<VelocityEstimate> product_estimate(double corner, double period);
/// Makes the difference over the last `ticks` (1 to 64) ticks.
std::unique_ptr<VelocityEstimate> window_estimate(int ticks, double period);
/// Makes the adaptive window: the longest one, up to `most` (1 to 64) ticks, in which a straight
/// line through its ends is within half an encoder step of every sample
/// [S Janabi-Sharifi, Hayward, Chen 2000: first-order adaptive windowing].
std::unique_ptr<VelocityEstimate> adaptive_estimate(int max, double step, double period);
/// Makes Levant's differentiator of first order for accelerations up to `most` m/s^2
/// [M Levant 1998: gains 1.1 and 1.5 root].
std::unique_ptr<VelocityEstimate> levant_estimate(double max, double period);

}  // namespace thimble::studies
