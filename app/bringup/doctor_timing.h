#pragma once

#include <vector>

#include "bringup/doctor.h"

namespace thimble::bringup {

/// Returns findings about the timing of a loop on this machine: real-time priority, the kernel's
/// limit of it, its preemption, the processors' governor and their sleep states. Values that the
/// kernel does not report are skipped. Reads below `system.root`; changes nothing. Real-time: never
/// from the servo thread. `arm`: an arm is plugged in, so that missing priority is a problem.
std::vector<Finding> examine_timing(const SystemInfo& system, bool arm);

}  // namespace thimble::bringup
