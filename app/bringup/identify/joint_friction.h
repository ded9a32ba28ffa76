#pragma once

#include <array>
#include <vector>

#include "bringup/identify/identify.h"
#include "bringup/identify/weak_form/fitted_motion.h"

namespace thimble::bringup {

/// Friction of one joint over one piece of motion of 60 ms.
struct FrictionPoint {
  double speed = 0;   ///< Of the joint in the middle of the piece, rad/s.
  double torque = 0;  ///< That resists positive rotation: what moved beside motors and weight, N m.
  double fitted = 0;  ///< The same by the constants of friction that were found, N m.
};

/// Returns the friction of each joint, piece by piece of those in which no axis stood: what is left
/// in the motion that was found, and what it was freed of. Real-time: never from the servo thread.
std::array<std::vector<FrictionPoint>, 3> joint_friction(const FittedMotion& motion,
                                                         const Identified& found);

}  // namespace thimble::bringup
