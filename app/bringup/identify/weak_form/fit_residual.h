#pragma once

#include <Eigen/Core>
#include <vector>

#include "bringup/identify/motion_fit.h"
#include "bringup/identify/weak_form/motion_equations.h"

namespace thimble::bringup {

/// What a fit leaves of each equation, and how that hangs on its constants.
struct FitResidual {
  /// d left / d constant, an equation each; the last column is the delay's (per s). Columns of
  /// constants that are exactly zero, which were not asked for, are zero.
  Eigen::MatrixXd rows;
  Eigen::VectorXd rest;       ///< m/s^2
  std::vector<int> clusters;  ///< Which half second each equation belongs to.
};

/// Returns what the constants and the delay of `fit` leave. Real-time: never from the servo thread.
FitResidual residual_of(const MotionEquations& equations, const PerMass& fit);

}  // namespace thimble::bringup
