#pragma once

#include "thimble/device_sim/settings.h"
#include "thimble/scene/arm_file.h"
#include "yaml/yaml_reader.h"

namespace thimble::scene {

/// Reads how an arm is simulated: the section `simulation` of its file, after all others. A
/// Falcon's converter and board are code, so that its file has nothing to say of them, nor of its
/// drive train. Mistakes are noted in the map. Real-time: never from the servo thread.
device_sim::SimulatedArmSettings read_simulation(YamlMap map, const ArmFile& arm);

}  // namespace thimble::scene
