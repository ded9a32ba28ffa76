#pragma once

#include <string_view>

#include "thimble/device_sim/settings.h"
#include "thimble/scene/arm_file.h"
#include "yaml/yaml_reader.h"

namespace thimble::scene {

/// Sentence for keys of arm files that only serial arms use.
inline constexpr std::string_view kNeedsSerialArm = "needs shape: serial";

/// Reads the section `simulation` of an arm file, after all other sections. The file of a Falcon
/// has no settings of board and drive train, because these are code. Mistakes are recorded in the
/// map. Real-time: never from the servo thread.
device_sim::SimulatedArmSettings read_simulation(YamlMap map, const ArmFile& arm);

}  // namespace thimble::scene
