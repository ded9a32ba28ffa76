#pragma once

#include <vector>

#include "bringup/doctor.h"

namespace thimble::bringup {

/// Returns what the doctor finds of how evenly a loop can run here: real-time priority, the
/// kernel's limit of it, its preemption, the processors' governor and their sleep. What the kernel
/// does not tell is passed over. Reads below `system.root`; changes nothing. Real-time: never from
/// the servo thread. `arm`: an arm is plugged in, so that missing priority is a problem.
std::vector<Finding> examine_timing(const SystemInfo& system, bool arm);

}  // namespace thimble::bringup
