#pragma once

#include <array>

#include "bringup/estimate.h"
#include "bringup/identify/weak_form/fitted_motion.h"

namespace thimble::app {

/// Dry friction of single joints beyond that of the tip, N m at the joint: what makes a joint
/// stick.
struct RubbingJoints {
  std::array<Estimate, 3> coulomb;
  /// The Bayesian information believes it, and it explains most of what the fit leaves.
  bool seen = false;

  /// Returns the joint that rubs most for its interval, from 0 on.
  int most() const;
};

/// Looks in what a fit leaves for friction that turns its sign with the joints rather than with the
/// axes of the base. `mass` (kg) makes forces of what is seen per mass. Real-time: never from the
/// servo thread.
RubbingJoints rubbing_joints(const FittedMotion& motion, double mass);

}  // namespace thimble::app
