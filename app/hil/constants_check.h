#pragma once

#include "hil/hil_rig.h"

namespace thimble::hil {

/// Identifies the arm and compares mass, frictions, weight, the motors' gains and the delay with
/// its file. Each may differ by a tenth or by its interval. Instead of a tenth, dry friction may
/// differ by a third, viscous friction by the same or 0.01 N s/m, weight by 5 mN, the delay by 0.2
/// ms. If there is a load on the tip, also compares the direction of gravity, to 3 degrees.
/// Skipped, with the reason, for arms that cannot be identified. Real-time: never from the servo
/// thread.
HilResult check_constants(const HilRig& rig, const HilOptions& options);

}  // namespace thimble::hil
