#pragma once

#include "hil/hil_rig.h"

namespace thimble::hil {

/// Asks the user to pull the arm's cable while a small force acts, and to plug it in again. The
/// driver must report the loss, assume that the force is off, and find the arm again. Skipped
/// unless `wanted`. Real-time: never from the servo thread.
HilResult check_cable_pull(const HilRig& rig, bool wanted);

}  // namespace thimble::hil
