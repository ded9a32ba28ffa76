#pragma once

#include <functional>
#include <vector>

#include "hil/hil_rig.h"

namespace thimble::app {

/// Called after each check.
using HilListener = std::function<void(const HilResult& result)>;

/// Runs the checks that need an arm: its reports, the feel check, its constants, its watchdog,
/// friction at rest, the stiffest wall against law and simulation, a spring of known stiffness, a
/// soak, and a cable that is pulled. What pushes is skipped where the arm has not passed its feel
/// check, and after a fault. Stops between two checks when `rig.stop` is set.
/// Real-time: never from the servo thread.
std::vector<HilResult> run_hil_suite(const HilRig& rig, const HilOptions& options,
                                     const HilListener& listener);

}  // namespace thimble::app
