#pragma once

#include "hil/hil_rig.h"

namespace thimble::hil {

/// Asks a person to pull the arm's cable while a small force stands, and to plug it in again: the
/// driver must name the loss, take the force to be off, and find the arm again. Skipped unless
/// `wanted`. Real-time: never from the servo thread.
HilResult check_cable_pull(const HilRig& rig, bool wanted);

}  // namespace thimble::hil
