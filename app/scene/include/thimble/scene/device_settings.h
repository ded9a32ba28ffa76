#pragma once

#include <optional>

#include "thimble/driver/device.h"
#include "thimble/driver/energy_guard.h"
#include "thimble/driver/export.h"
#include "thimble/scene/arm_file.h"

namespace thimble::scene {

/// Returns what `driver::Device::open` needs to know of the arm of a file in a loop of `rate` (Hz):
/// its place, the limits and the energy stage of its gate, what its motion is watched by, its heat,
/// the walls around its workspace.
/// A scene may name another energy stage. Real-time: never from the servo thread.
THIMBLE_EXPORT driver::DeviceSettings device_settings(
    const ArmFile& arm, double rate, std::optional<driver::EnergyStage> stage = {});

}  // namespace thimble::scene
