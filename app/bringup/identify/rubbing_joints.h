#pragma once

#include <Eigen/Core>
#include <array>

#include "bringup/estimate.h"
#include "bringup/identify/arm_motion.h"
#include "bringup/identify/motion_fit.h"
#include "bringup/identify/weak_form/fitted_motion.h"
#include "thimble/driver/result.h"

namespace thimble::bringup {

/// Friction of the joints of a rigid arm, which turns its sign with them rather than with the axes
/// of the base (device_sim::DriveTrainSettings). Torques by the arm file's constants.
struct RubbingJoints {
  bool searched = false;              ///< It was looked for.
  bool seen = false;                  ///< The data show it.
  bool tip_rubs = true;               ///< Friction along the axes of the base is seen beside it.
  Estimate tip_coulomb, tip_viscous;  ///< That, per mass at the tip, N/kg and N s/(m kg).
  std::array<Estimate, 3> coulomb;    ///< Of each joint, N m.
  std::array<Estimate, 3> viscous;    ///< N m s/rad
  /// What would have been seen, N m and N m s/rad; zero: nothing was looked for.
  std::array<double, 3> coulomb_below{}, viscous_below{};
  double left = 1;   ///< Share of the residual's square that is left with it.
  double delay = 0;  ///< With which torques come, s.

  /// Returns the joint that rubs most for its interval, from 0 on.
  int most() const;
  /// Returns the joint that sticks: it rubs ten times as much as either of the others, and more
  /// than the tip, whose dry friction is `tip` (N), at a lever of 1 / |G_row| (`levers`, m); else
  /// -1.
  int stuck(double tip, const Eigen::Vector3d& levers) const;
};

/// Looks for friction of joints in a fit of a rigid arm's motion, and believes it where the
/// Bayesian information does. Friction of tip and joints that the motion cannot tell apart is the
/// tip's. Fails as `fit_motion` does. Real-time: never from the servo thread.
driver::Result<RubbingJoints> find_rubbing_joints(const ArmMotion& motion, const PerMass& fit);

/// Returns a motion with the torques that are left beside such friction, by the arm file's
/// constants. `fit`: of this motion, for how friction bends it where joints turn. Real-time: never
/// from the servo thread.
ArmMotion freed_of_rubbing(const ArmMotion& motion, const RubbingJoints& rubbing,
                           const PerMass& fit);

/// Looks once in what a fit leaves of a motion, which is bad, for dry friction of joints: torques
/// by the arm file's constants. Real-time: never from the servo thread.
RubbingJoints rubbing_left(const FittedMotion& motion);

}  // namespace thimble::bringup
