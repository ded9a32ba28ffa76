#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>

#include "bringup/identify/cables/backlash/backlash_pieces.h"

namespace thimble::bringup {

/// Constants searched for in addition to gains, delay, tip, motors and cables.
struct BacklashSought {
  bool play = false;      ///< Widths of the backlash.
  bool friction = false;  ///< Friction of the motors' side.
};

/// A fit of BacklashTheta to pieces of a motion.
struct BacklashFit {
  BacklashTheta::Vector theta = BacklashTheta::Vector::Zero();
  /// Zero for a constant that was not searched for.
  Eigen::Matrix<double, BacklashTheta::kCount, BacklashTheta::kCount> covariance =
      Eigen::Matrix<double, BacklashTheta::kCount, BacklashTheta::kCount>::Zero();
  double chi2 = 0;           ///< Sum of squared residuals over the variance of the encoders' steps.
  double misfit = HUGE_VAL;  ///< chi^2 per degree of freedom; infinite if nothing was fitted.
  double samples = 0;        ///< Number of fitted angles.
  std::size_t pieces = 0;    ///< Number of fitted pieces.
  double lost = 0;  ///< Share of the pieces that lost track of the motion and were omitted.
};

/// Fits BacklashTheta to the motors' angles (output error) by multiple shooting. The model moves
/// over each piece from a state of its own, and states and constants together minimize the
/// residual. Short pieces avoid the chaos of a motor that rattles in its backlash. The search is
/// that of Levenberg and Marquardt, with the states eliminated piece by piece. Constants that are
/// not in `sought` keep their values in `from`. Real-time: never from the servo thread.
BacklashFit fit_backlash(BacklashPieces pieces, const BacklashTheta::Vector& from,
                         const BacklashSought& sought, int rounds);

}  // namespace thimble::bringup
