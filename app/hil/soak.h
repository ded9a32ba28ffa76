#pragma once

#include "hil/hil_rig.h"

namespace thimble::hil {

/// Moves a free arm with up to 0.95 N for minutes on end, and counts: faults, ticks without a
/// report, reports that were rejected and messages that the arm refused. The heat of its motors is
/// judged along the way (HeatWatch): by the arm file's model, and of a simulated arm by what is
/// true of its windings. Real-time: never from the servo thread.
HilResult check_soak(const HilRig& rig, double minutes);

}  // namespace thimble::hil
