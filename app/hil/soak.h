#pragma once

#include "hil/hil_rig.h"

namespace thimble::app {

/// Moves a free arm with up to 0.95 N for minutes on end, and counts: faults, ticks without a
/// report, reports that were rejected, messages that the arm refused, and the heat of its motors by
/// the arm file's model. Real-time: never from the servo thread.
HilResult check_soak(const HilRig& rig, double minutes);

}  // namespace thimble::app
