#pragma once

#include <filesystem>
#include <vector>

#include "thimble/driver/result.h"
#include "thimble/scene/scene_file.h"
#include "yaml/yaml_reader.h"

namespace thimble::scene {

/// Reads the list `arms` of a scene, and `faults`. Sets `arms` to the maps of the list;
/// `read_hands` reads their hands once the objects are known. `folder`: that of the scene. Formal
/// mistakes are recorded in the maps. Fails on an error in an arm file, or if the caller supports
/// only one arm. Real-time: never from the servo thread.
driver::Result<void> read_arms(YamlMap& root, const std::filesystem::path& folder,
                               const SceneReading& reading, std::vector<YamlMap>& arms,
                               Scene& scene);

/// Reads the hands of the arms from `read_arms`. Precondition: the scene's objects are read.
/// `folder`: that of the scene. Real-time: never from the servo thread.
void read_hands(std::vector<YamlMap>& arms, const std::filesystem::path& folder, Scene& scene);

}  // namespace thimble::scene
