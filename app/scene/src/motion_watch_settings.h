#pragma once

#include "thimble/driver/motion_watch.h"
#include "thimble/scene/arm_file.h"

namespace thimble::scene {

/// Returns what the motion watch of an arm goes by, in a loop of `rate` (Hz): the mass at the tip
/// (`gate.tip_mass`, else that of the simulation, else 0.1 kg), the delay, and how long a force is
/// held while no encoder counts (`gate.hold_unchanged`). Real-time: never from the servo thread.
driver::MotionWatchSettings motion_settings(const ArmFile& arm, double rate);

}  // namespace thimble::scene
