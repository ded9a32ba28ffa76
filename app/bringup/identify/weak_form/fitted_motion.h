#pragma once

#include <Eigen/Core>

#include "bringup/identify/weak_form/fit_residual.h"
#include "bringup/identify/weak_form/motion_equations.h"

namespace thimble::bringup {

/// A motion, the constants fitted to it, and their residuals, in which further constants are
/// searched for. The motion must outlive it. Real-time: never from the servo thread.
struct FittedMotion {
  MassNormalisedFit fit;
  MotionEquations equations;
  FitResidual residual;

  FittedMotion(const ArmMotion& motion, const MassNormalisedFit& fitted)
      : fit(fitted), equations(motion, !fitted.theta.tail<3>().isZero(0)) {
    equations.find_signs(fit.theta[MassNormalisedFit::kCoulomb]);
    residual = residual_of(equations, fit);
  }

  const ArmMotion& motion() const { return equations.motion(); }
};

}  // namespace thimble::bringup
