#pragma once

#include <Eigen/Core>

#include "thimble/driver/export.h"

namespace thimble::driver {

/// Estimates velocity from sampled positions: backward difference, then one low-pass pole.
///
/// The pole costs stability: it adds about T(1-a)/a, a = 1 - exp(-2 pi f T), to the loop's latency
/// for damping forces [PHYSICS 1.1]. In return, these forces contain less encoder noise (B * step /
/// T without the pole). All functions are Real-time: safe.
class THIMBLE_EXPORT VelocityEstimator {
 public:
  /// Takes the corner frequency of the pole in Hz; 0 means the plain difference.
  explicit VelocityEstimator(double corner_frequency = 0) noexcept;

  /// Clears the history; the next estimate is zero.
  void reset() noexcept { primed_ = false; }

  /// Returns whether a position has been taken since `reset`.
  bool primed() const noexcept { return primed_; }

  /// Takes the position p (m) sampled `dt` (s) after the previous one and returns the velocity,
  /// m/s. A `dt` that is not positive returns the last estimate.
  Eigen::Vector3d update(const Eigen::Vector3d& p, double dt) noexcept;

 private:
  double corner_frequency_;
  double pole_dt_ = -1;  // value of dt for which `gain_` was computed
  double gain_ = 1;
  bool primed_ = false;
  Eigen::Vector3d p_{0, 0, 0};
  Eigen::Vector3d v_{0, 0, 0};
};

}  // namespace thimble::driver
