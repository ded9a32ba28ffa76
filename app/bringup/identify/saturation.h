#pragma once

#include <array>

#include "bringup/identify/weak_form/fitted_motion.h"

namespace thimble::bringup {

/// Whether a motor gives all of the torque that it is asked for.
struct Saturation {
  bool seen = false;      ///< It gives no more than `most`: the data show it.
  Estimate most;          ///< The torque beyond which it gives no more, N m at the joint by the arm
                          ///< file's constants; where none was seen nothing.
  double asked = 0;       ///< The largest torque that it was asked for, N m at the joint.
  bool searched = false;  ///< So much was asked for that it would have been seen.
};

/// Looks for amplifiers that saturate, joint by joint: what was asked for beyond some torque then
/// moves nothing. Real-time: never from the servo thread.
std::array<Saturation, 3> saturations(const FittedMotion& motion);

}  // namespace thimble::bringup
