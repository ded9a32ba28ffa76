#pragma once

#include <Eigen/Core>
#include <array>

#include "bringup/estimate.h"
#include "bringup/identify/cables/backlash/backlash_fit.h"
#include "bringup/identify/cables/two_mass_fit.h"
#include "bringup/identify/motion_fit.h"

namespace thimble::bringup {

/// Friction of the motors' side, whose sign follows the motors and not the tip, joint by joint.
/// Torques use the arm file's torque constants, at the joints. If one is not seen, it would have
/// been above value + plus_minus.
struct RotorFriction {
  std::array<Estimate, 3> viscous;  ///< N m s/rad
  std::array<Estimate, 3> coulomb;  ///< N m
  std::array<bool, 3> shows_viscous{}, shows_coulomb{};
  double better = 0;  ///< Gain of the Bayesian information criterion by it.
  bool fits = false;  ///< Its residual is only that of the encoders' steps.
  bool seen = false;  ///< It fits, the gain suffices, and some of the constants show.
};

/// Result of the search for backlash in the cables, and for friction of their motors.
struct BacklashResult {
  bool searched = false;
  BacklashFit without, with;  ///< Fits without and with backlash, to the same pieces of motion.
  BacklashFit plain;          ///< Fit without backlash and without friction of the motors.
  RotorFriction friction;
  double better = 0;  ///< Gain of the Bayesian information criterion by backlash.
  bool seen = false;  ///< Backlash is accepted: the gain suffices, and the residual is small.
  bool fits = false;  ///< The residual of the better fit is little more than the encoders' steps.
  /// Neither fits, though backlash leaves a far smaller residual: a similar effect that is not
  /// understood.
  bool looks_like_backlash = false;
  /// Whole widths, rad at the joints, and whether each is seen. If one is not seen, it would have
  /// been above value + plus_minus.
  std::array<Estimate, 3> width;
  std::array<bool, 3> shows{};

  /// Returns whether backlash or friction of motors is reported; the motion is understood only with
  /// it.
  bool is_reported() const { return seen || friction.seen; }
  /// Returns whether the better fit leaves only the encoders' steps. Motors and cables are then
  /// known better from it than from lines, with or without backlash.
  bool fits_to_steps() const;
  const BacklashFit& best() const { return seen ? with : without; }
};

/// Searches for backlash, and for friction of the motors, in a motion whose fits as a rigid arm and
/// as lines are known. Real-time: never from the servo thread.
BacklashResult find_backlash(const ArmMotion& motion, const MassNormalisedFit& rigid,
                             const CableFit& lines);

/// Returns the constants of the same arm with another mass on its tip, fitted from those without it
/// (`bare`, of the motion whose rigid fit is `rigid_bare`). Real-time: never from the servo thread.
BacklashFit fit_backlash_again(const ArmMotion& motion, const MassNormalisedFit& rigid,
                               const MassNormalisedFit& rigid_bare, const BacklashResult& bare);

}  // namespace thimble::bringup
