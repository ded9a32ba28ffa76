#pragma once

#include "thimble/driver/motion_watch.h"
#include "thimble/scene/arm_file.h"

namespace thimble::scene {

/// Returns the settings of an arm's motion watch in a loop of `rate` (Hz). These are the mass at
/// the tip (`gate.tip_mass`, else that of the simulation, else 0.1 kg), the delay, and the longest
/// time of a force while no encoder counts (`gate.hold_unchanged`). Real-time: never from the servo
/// thread.
driver::MotionWatchSettings motion_settings(const ArmFile& arm, double rate);

}  // namespace thimble::scene
