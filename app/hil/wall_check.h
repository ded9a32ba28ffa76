#pragma once

#include "hil/hil_rig.h"

namespace thimble::hil {

/// Searches for the stiffest wall of the free arm, and for that of the simulated arm of the file by
/// the same search from the same starts. They differ if the median over the starts of their ratio
/// is more than a tenth from 1; `full` uses 65 starts instead of 33. Real-time: never from the
/// servo thread.
HilResult check_stiffest_wall(const HilRig& rig, bool full);

}  // namespace thimble::hil
