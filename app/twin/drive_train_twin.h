#pragma once

#include <memory>

#include "thimble/driver/result.h"
#include "thimble/scene/arm_file.h"
#include "twin/twin_motion.h"
#include "twin/twin_mover.h"

namespace thimble::twin {

/// Makes the arm of a file that names a drive train. It is the plant itself (device_sim,
/// drive_train_plant.h), in sub-steps of 0.1 ms. A resonance w (rad/s) is too high by (w
/// 0.1 ms)^2 / 24, 0.07 % at 200 Hz. Fails if a constant is out of range. `motion` must outlive it.
driver::Result<std::unique_ptr<TwinMover>> make_drive_train_twin(const TwinMotion& motion,
                                                                 const scene::ArmFile& file);

}  // namespace thimble::twin
