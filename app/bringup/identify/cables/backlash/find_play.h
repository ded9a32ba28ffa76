#pragma once

#include <Eigen/Core>
#include <array>

#include "bringup/estimate.h"
#include "bringup/identify/cables/backlash/gap_fit.h"
#include "bringup/identify/cables/two_mass_fit.h"
#include "bringup/identify/motion_fit.h"

namespace thimble::bringup {

/// Friction of the motors' side, which turns its sign with the motors and not with the tip, joint
/// by joint. Its torques are those of the arm file's torque constants, at the joints; one that is
/// not seen would have been above value + plus_minus.
struct RotorFriction {
  std::array<Estimate, 3> viscous;  ///< N m s/rad
  std::array<Estimate, 3> coulomb;  ///< N m
  std::array<bool, 3> shows_viscous{}, shows_coulomb{};
  double better = 0;  ///< By how much the Bayesian information prefers it.
  bool fits = false;  ///< Nothing but the encoders' steps is left with it.
  bool seen = false;  ///< It fits, is so much better, and some of it shows.
};

/// What a motion shows of play in the cables, and of friction of the motors before them.
struct PlayFit {
  bool searched = false;
  GapFit without, with;  ///< Without and with play, fitted to the same pieces of motion.
  GapFit plain;          ///< Without play and without friction of the motors.
  RotorFriction friction;
  double better = 0;  ///< By how much the Bayesian information prefers play.
  bool seen = false;  ///< Play is believed: it is so much better, and what is left is small.
  bool fits = false;  ///< The better of both leaves little more than the encoders' steps.
  /// Neither fits, though play leaves far less: something like it, which is not understood.
  bool like_play = false;
  /// Whole widths, rad at the joints, and whether each is seen. One that is not would have been
  /// above value + plus_minus.
  std::array<Estimate, 3> width;
  std::array<bool, 3> shows{};

  /// Returns whether play or friction of motors is told, by which alone the motion is understood.
  bool told() const { return seen || friction.seen; }
  /// Returns whether the better fit leaves the encoders' steps alone: then motors and cables are
  /// known better by it than by lines, with play or without.
  bool understood() const;
  const GapFit& best() const { return seen ? with : without; }
};

/// Looks for play, and for friction of the motors, in a motion, whose fits as that of a rigid arm
/// and as lines are known. Real-time: never from the servo thread.
PlayFit find_play(const ArmMotion& motion, const PerMass& rigid, const CableFit& lines);

/// Returns the constants of the same arm with another mass on its tip, fitted from those without it
/// (`bare`, of the motion whose rigid fit is `rigid_bare`). Real-time: never from the servo thread.
GapFit fit_play_again(const ArmMotion& motion, const PerMass& rigid, const PerMass& rigid_bare,
                      const PlayFit& bare);

}  // namespace thimble::bringup
