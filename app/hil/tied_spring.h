#pragma once

#include "hil/hil_rig.h"

namespace thimble::hil {

/// Pulls at a spring of known stiffness that the user tied to the tip, along y, in steps up and
/// down, and compares how far it gives with what the spring says: the true force over the one that
/// was asked for. Dry friction holds the tip back on the way up as much as on the way down, so the
/// mean of both is taken. Skipped without a spring. Real-time: never from the servo thread.
HilResult check_tied_spring(const HilRig& rig, double stiffness);

}  // namespace thimble::hil
