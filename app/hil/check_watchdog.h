#pragma once

#include "hil/hil_rig.h"

namespace thimble::hil {

/// Measures the time after which the arm's own watchdog switches its motors off. A free tip is
/// pushed with slightly more than its dry friction, then nothing is sent; the tip's speed is
/// greatest when the force ends. A tip that has moved 15 mm is released before that by a message of
/// zero force. Skipped, with the reason, if that distance is too short, or if the arm sends only
/// when asked.
HilResult check_watchdog_time(const HilRig& rig);

}  // namespace thimble::hil
