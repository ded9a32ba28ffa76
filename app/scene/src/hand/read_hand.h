#pragma once

#include <filesystem>
#include <vector>

#include "thimble/device_sim/settings.h"
#include "thimble/scene/hand_route.h"
#include "thimble/scene/scene_file.h"
#include "yaml/yaml_reader.h"

namespace thimble::scene {

/// Reads the path of a simulated hand among `objects`, and its `grip` if the scene defines another
/// one than the arm file. `folder`: that of the scene, for bags. Mistakes are recorded in the map.
/// Real-time: never from the servo thread.
std::vector<HandWaypoint> read_hand(YamlMap map, const std::vector<SceneObject>& objects,
                                    const std::filesystem::path& folder,
                                    device_sim::HandSettings& grip);

}  // namespace thimble::scene
