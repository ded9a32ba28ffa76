#pragma once

#include "hil/hil_rig.h"

namespace thimble::app {

/// Identifies the arm and compares mass, dry friction, the motors' gains and the delay with its
/// file: each may differ by a tenth (friction by a third, the delay by 0.2 ms) or by its interval.
/// Skipped, with the reason, for arms that cannot be identified. Real-time: never from the servo
/// thread.
HilResult check_constants(const HilRig& rig, double seconds);

}  // namespace thimble::app
