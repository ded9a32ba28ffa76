#pragma once

#include <optional>

#include "thimble/driver/device.h"
#include "thimble/driver/energy_guard.h"
#include "thimble/driver/export.h"
#include "thimble/scene/arm_file.h"

namespace thimble::scene {

/// Returns the device settings of an arm file for a loop of `rate` (Hz): place, gate limits, energy
/// stage, motion watch, heat and workspace walls. `stage`, if set, replaces the arm's energy stage.
/// Real-time: never from the servo thread.
THIMBLE_EXPORT driver::DeviceSettings device_settings(
    const ArmFile& arm, double rate, std::optional<driver::EnergyStage> stage = {});

}  // namespace thimble::scene
