#pragma once

#include <Eigen/Core>
#include <array>

#include "bringup/estimate.h"
#include "bringup/identify/arm_motion.h"
#include "bringup/identify/motion_fit.h"
#include "bringup/identify/weak_form/fitted_motion.h"
#include "thimble/driver/result.h"

namespace thimble::bringup {

/// Friction of the joints of a rigid arm, whose sign follows the joints and not the axes of the
/// base (device_sim::DriveTrainSettings). Torques use the arm file's constants.
struct JointFrictionFit {
  bool searched = false;              ///< A search was made.
  bool seen = false;                  ///< It is significant.
  bool tip_rubs = true;               ///< Friction along the axes of the base is seen in addition.
  Estimate tip_coulomb, tip_viscous;  ///< That friction, per mass at the tip, N/kg and N s/(m kg).
  std::array<Estimate, 3> coulomb;    ///< Dry friction of each joint, N m.
  std::array<Estimate, 3> viscous;    ///< Viscous friction of each joint, N m s/rad.
  /// Detection limits, N m and N m s/rad; zero: not searched for.
  std::array<double, 3> coulomb_below{}, viscous_below{};
  double left = 1;   ///< Remaining share of the squared residual.
  double delay = 0;  ///< Delay of torques, s.

  /// Returns the joint whose friction is largest relative to its interval, from 0 on.
  int strongest_joint() const;
  /// Returns the joint that sticks, else -1. Its friction is ten times that of either of the
  /// others, and more than that of the tip, whose dry friction is `tip` (N), at a lever of 1 /
  /// |G_row| (`levers`, m).
  int stuck(double tip, const Eigen::Vector3d& levers) const;
};

/// Searches for friction of joints in a fit of a rigid arm's motion, and accepts it by the Bayesian
/// information criterion. Friction of tip and joints that the motion does not distinguish is
/// assigned to the tip. Fails like `fit_motion`. Real-time: never from the servo thread.
driver::Result<JointFrictionFit> fit_joint_friction(const ArmMotion& motion,
                                                    const MassNormalisedFit& fit);

/// Returns a motion with the torques that remain without such friction, in the arm file's
/// constants. `fit` of this motion gives the deceleration by friction where joints reverse.
/// Real-time: never from the servo thread.
ArmMotion without_joint_friction(const ArmMotion& motion, const JointFrictionFit& rubbing,
                                 const MassNormalisedFit& fit);

/// Searches once for dry friction of joints in the residual of a bad fit; torques use the arm
/// file's constants. Real-time: never from the servo thread.
JointFrictionFit joint_friction_left(const FittedMotion& motion);

}  // namespace thimble::bringup
