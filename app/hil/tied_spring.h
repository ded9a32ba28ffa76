#pragma once

#include "hil/hil_rig.h"

namespace thimble::hil {

/// Pulls at a spring of known stiffness that the user tied to the tip, along y, in steps up and
/// down. The elongation of the spring gives the true force, which is compared with the requested
/// one. Dry friction has opposite effects on the way up and down, so the mean of both is taken.
/// Skipped without a spring. Real-time: never from the servo thread.
HilResult check_tied_spring(const HilRig& rig, double stiffness);

}  // namespace thimble::hil
