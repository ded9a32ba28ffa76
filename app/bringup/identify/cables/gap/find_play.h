#pragma once

#include <Eigen/Core>
#include <array>

#include "bringup/estimate.h"
#include "bringup/identify/cables/gap/gap_fit.h"
#include "bringup/identify/cables/two_mass_fit.h"
#include "bringup/identify/motion_fit.h"

namespace thimble::app {

/// What a motion shows of play in the cables.
struct PlayFit {
  bool searched = false;
  GapFit without, with;  ///< Fitted to the same pieces of motion.
  double better = 0;     ///< By how much the Bayesian information prefers play.
  bool seen = false;     ///< Play is believed: it is so much better, and what is left is small.
  bool fits = false;     ///< The better of both leaves little more than the encoders' steps.
  /// Neither fits, though play leaves far less: something like it, which is not understood.
  bool like_play = false;
  /// Whole widths, rad at the joints, and whether each is seen. One that is not would have been
  /// above value + plus_minus.
  std::array<Estimate, 3> width;
  std::array<bool, 3> shows{};
};

/// Looks for play in a motion, whose fits as that of a rigid arm and as lines are known.
/// Real-time: never from the servo thread.
PlayFit find_play(const ArmMotion& motion, const PerMass& rigid, const CableFit& lines);

/// Returns the constants of the same arm with another mass on its tip, fitted from those without it
/// (`bare`, of the motion whose rigid fit is `rigid_bare`). Real-time: never from the servo thread.
GapFit fit_play_again(const ArmMotion& motion, const PerMass& rigid, const PerMass& rigid_bare,
                      const GapFit& bare);

/// Returns what a fit with play says of what moves the tip, in place of the weak form's: a spring
/// that holds the tip is in it. `windows` are its pieces.
PerMass per_mass_of(const GapFit& fit, const ArmMotion& motion);

/// Returns what it says of motors and cables, in place of the lines' `before`.
TwoMass two_mass_of(const GapFit& fit, const TwoMass& before);

}  // namespace thimble::app
