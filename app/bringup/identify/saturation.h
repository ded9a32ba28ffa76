#pragma once

#include <array>

#include "bringup/identify/weak_form/fitted_motion.h"

namespace thimble::bringup {

/// Whether a motor delivers all of the requested torque.
struct Saturation {
  bool seen = false;    ///< It delivers at most `max_torque`: significant.
  Estimate max_torque;  ///< Max. torque, N m at the joint with the arm file's constants; empty if
                        ///< none was seen.
  double asked = 0;       ///< Largest requested torque, N m at the joint.
  bool searched = false;  ///< The requested torque was large enough to show saturation.
};

/// Searches for amplifiers that saturate, joint by joint: torque requested beyond some value then
/// moves nothing. Real-time: never from the servo thread.
std::array<Saturation, 3> saturations(const FittedMotion& motion);

}  // namespace thimble::bringup
