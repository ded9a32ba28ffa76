#pragma once

#include <memory>

#include "bringup/bench_arm.h"
#include "thimble/driver/result.h"

namespace thimble::bringup {

/// Opens the simulated arm of a file for identification. Its tip is in the middle of the workspace,
/// without a hand, and with a mass fixed to it (kg, 0: none) on which gravity acts. With `hold_it`,
/// the arm file's hand holds it. Forces are limited to `max_force` (N). Real-time: never from the
/// servo thread.
driver::Result<std::unique_ptr<BenchArm>> simulated_bench(const scene::ArmFile& file,
                                                          double added_mass, bool hold_it = false,
                                                          double max_force = 1);

}  // namespace thimble::bringup
