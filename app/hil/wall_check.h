#pragma once

#include "hil/hil_rig.h"

namespace thimble::hil {

/// Looks for the stiffest wall that the free arm carries, and for that of the simulated arm of the
/// file by the same search from the same starts. It differs where the median over the starts of
/// one by the other is further than a tenth from 1; `full` takes 65 starts rather than 33.
/// Real-time: never from the servo thread.
HilResult check_stiffest_wall(const HilRig& rig, bool full);

}  // namespace thimble::hil
