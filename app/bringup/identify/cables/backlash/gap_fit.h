#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>

#include "bringup/identify/cables/backlash/gap_pieces.h"

namespace thimble::bringup {

/// What is searched for beside gains, delay, tip, motors and cables.
struct GapSought {
  bool play = false;      ///< The widths.
  bool friction = false;  ///< That of the motors' side.
};

/// A fit of GapTheta to pieces of a motion.
struct GapFit {
  GapTheta::Vector theta = GapTheta::Vector::Zero();
  /// Zero where a constant was not searched for.
  Eigen::Matrix<double, GapTheta::kCount, GapTheta::kCount> covariance =
      Eigen::Matrix<double, GapTheta::kCount, GapTheta::kCount>::Zero();
  double chi2 = 0;           ///< Squares of what is left, over the variance of the encoders' steps.
  double misfit = HUGE_VAL;  ///< chi^2 per degree of freedom; infinite if nothing was fitted.
  double samples = 0;        ///< Angles that were fitted.
  std::size_t pieces = 0;    ///< That they are of.
  double lost = 0;           ///< Share of the pieces that lost the track and were left out.
};

/// Fits GapTheta to the motors' angles (output error) by multiple shooting: the model moves over
/// each of the pieces from a state of its own, and states and constants together leave the least.
/// Short pieces keep what rattles in its play from being chaotic over them. The search is
/// Levenberg's and Marquardt's, the states eliminated piece by piece. Constants that are not among
/// `sought` stay as they are in `from`. Real-time: never from the servo thread.
GapFit fit_gap(GapPieces pieces, const GapTheta::Vector& from, const GapSought& sought, int rounds);

}  // namespace thimble::bringup
