#pragma once

#include <Eigen/Core>
#include <vector>

#include "bringup/estimate.h"
#include "bringup/identify/arm_motion.h"
#include "thimble/driver/result.h"

namespace thimble::bringup {

/// Constants of a motion, per moved mass, which is all that motion can determine.
///
///     p'' = sum_i g_i G_i^T tau_i(t - delay) - b p' - c sgn(p') + w - k (p - p_0)
///           - sum_i j_i G_i^T q_i'',
///
/// row i of G for joint i, j_i the inertia of a motor that is not included in its torque yet.
/// Torques and mass scale together, so only the ratios are seen.
struct MassNormalisedFit {
  /// Index of each constant in `theta`.
  enum Index {
    kGain = 0,
    kViscous = 3,
    kCoulomb = 4,
    kWeight = 5,
    kStiffness = 8,
    kInertia = 9,
    kCount = 12
  };

  Eigen::Matrix<double, kCount, 1> theta = Eigen::Matrix<double, kCount, 1>::Zero();
  Eigen::Matrix<double, kCount, kCount> covariance = Eigen::Matrix<double, kCount, kCount>::Zero();
  Estimate delay;            ///< Delay from the force to the motion that the host sees, s.
  int motors = 3;            ///< Number of motors; the gains of others are 0.
  double residual = 0;       ///< RMS residual of the acceleration, m/s^2.
  double noise = 0;          ///< RMS residual due to the encoders' steps only, m/s^2.
  double explained = 0;      ///< Share of the acceleration's variance that the model explains.
  std::size_t windows = 0;   ///< Number of fitted pieces of motion.
  std::size_t left_out = 0;  ///< Pieces in which an axis stood still for too long.
};

/// Fits a motion in the weak form: both sides are integrated against smooth bumps of 60 ms, so that
/// positions need no differentiation. Linear least squares gives all constants but the delay, which
/// a line search finds to a fraction of a tick. The covariance uses clusters of half a second,
/// whatever their residuals' correlation. `with_stiffness`: a spring holds the tip (a hand).
/// `with_inertia`: motors have an inertia, and the samples contain their accelerations. Fails if
/// the motion is too short or has too few windows. Real-time: never from the servo thread.
driver::Result<MassNormalisedFit> fit_motion(const ArmMotion& motion, bool with_stiffness,
                                             bool with_inertia = false);

}  // namespace thimble::bringup
