#pragma once

#include <memory>

#include "bringup/bench_arm.h"
#include "thimble/driver/result.h"

namespace thimble::bringup {

/// Opens the simulated arm of a file as one that is to be identified: its tip in the middle of the
/// workspace, nobody's hand on it, and a mass fixed to it (kg, 0: none) that gravity pulls on. An
/// arm file that lets a hand hold it (`hold_it`) keeps its hand. No force above `force_most` (N)
/// is let through. Real-time: never from the servo thread.
driver::Result<std::unique_ptr<BenchArm>> simulated_bench(const scene::ArmFile& file,
                                                          double added_mass, bool hold_it = false,
                                                          double force_most = 1);

}  // namespace thimble::bringup
