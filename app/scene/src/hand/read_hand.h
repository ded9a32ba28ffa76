#pragma once

#include <filesystem>
#include <vector>

#include "thimble/device_sim/settings.h"
#include "thimble/scene/hand_route.h"
#include "thimble/scene/scene_file.h"
#include "yaml/yaml_reader.h"

namespace thimble::scene {

/// Reads what a simulated hand does among `objects`, and how it holds the arm (`grip`) where the
/// scene wants another grip than the arm's file. `folder`: the scene's, where a bag lies. Mistakes
/// are noted in the map. Real-time: never from the servo thread.
std::vector<HandWaypoint> read_hand(YamlMap map, const std::vector<SceneObject>& objects,
                                    const std::filesystem::path& folder,
                                    device_sim::HandSettings& grip);

}  // namespace thimble::scene
