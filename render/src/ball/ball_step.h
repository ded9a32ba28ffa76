#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>

#include "ball/ball_feature.h"
#include "thimble/driver/export.h"

namespace thimble::render {

/// Step of a ball towards the point of all half-spaces of its features that is closest to the tip.
struct BallStep {
  Eigen::Vector3d y{0, 0, 0};           ///< Step of the centre, m.
  std::array<std::size_t, 3> active{};  ///< Features that hold the ball there.
  std::array<double, 3> weight{};       ///< Their parts: tip to centre = sum weight_i n_i; m.
  std::size_t count = 0;                ///< Number of these features.
  bool feasible = true;                 ///< False if rounding leaves no such point.
};

/// Finds the step y of a ball from its centre q that minimises y^T H y / 2 + (q - p) . y, with n_i
/// . y >= -gap_i for all features. With H = 1 this is the point of all half-spaces closest to the
/// tip p. `to_tip` is p - q, `H` is symmetric and positive definite, `tolerance` (m) is a depth
/// that counts as rounding. Real-time: safe; some 100 ns for each half-space that is met on the
/// way.
THIMBLE_EXPORT BallStep ball_step(std::span<const BallFeature> features,
                                  const Eigen::Vector3d& to_tip, const Eigen::Matrix3d& H,
                                  double tolerance) noexcept;

}  // namespace thimble::render
