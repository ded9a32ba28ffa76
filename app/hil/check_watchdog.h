#pragma once

#include "hil/hil_rig.h"

namespace thimble::hil {

/// Measures the time after which the arm's own watchdog switches its motors off: a free tip is
/// pushed a little above its dry friction, then nothing is sent any more, and the tip's speed is
/// greatest when the force goes off. A tip that has gone 15 mm is let go by a message of zero force
/// before that. Skipped, with the reason, where that way is too short to see it, or where the arm
/// speaks only when spoken to.
HilResult check_watchdog_time(const HilRig& rig);

}  // namespace thimble::hil
