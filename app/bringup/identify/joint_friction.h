#pragma once

#include <array>
#include <vector>

#include "bringup/identify/identify.h"
#include "bringup/identify/weak_form/fitted_motion.h"

namespace thimble::bringup {

/// Friction of one joint over one piece of motion of 60 ms.
struct FrictionPoint {
  double speed = 0;   ///< Speed of the joint in the middle of the piece, rad/s.
  double torque = 0;  ///< Torque that resists positive rotation, without motors and weight, N m.
  double fitted = 0;  ///< The same from the friction constants found, N m.
};

/// Returns the friction of each joint for each piece in which no axis stood still: the residual of
/// the fit plus the friction that was removed. Real-time: never from the servo thread.
std::array<std::vector<FrictionPoint>, 3> joint_friction(const FittedMotion& motion,
                                                         const Identified& found);

}  // namespace thimble::bringup
