#pragma once

#include <Eigen/Core>
#include <vector>

#include "bringup/identify/motion_fit.h"
#include "bringup/identify/weak_form/motion_equations.h"

namespace thimble::bringup {

/// Residual of each equation, and its derivatives by the constants.
struct FitResidual {
  /// d residual / d constant, an equation each; the last column is the delay's (per s). Columns of
  /// constants that are exactly zero, which were not requested, are zero.
  Eigen::MatrixXd rows;
  Eigen::VectorXd rest;       ///< m/s^2
  std::vector<int> clusters;  ///< Half second of each equation, as a cluster number.
};

/// Returns the residuals of the constants and the delay of `fit`. Real-time: never from the servo
/// thread.
FitResidual residual_of(const MotionEquations& equations, const MassNormalisedFit& fit);

}  // namespace thimble::bringup
