#pragma once

#include "hil/hil_rig.h"

namespace thimble::hil {

/// Moves a free arm with up to 0.95 N for minutes, and counts faults, ticks without a report,
/// rejected reports and refused messages. It also judges the heat of the motors (HeatWatch): by the
/// arm file's model and, on a simulated arm, by the true heat of its windings. Real-time: never
/// from the servo thread.
HilResult check_soak(const HilRig& rig, double minutes);

}  // namespace thimble::hil
