#pragma once

#include <filesystem>
#include <vector>

#include "thimble/driver/result.h"
#include "thimble/scene/scene_file.h"
#include "yaml/yaml_reader.h"

namespace thimble::scene {

/// Reads the list `arms` of a scene, and `faults`. Gives the maps of the list, whose hands
/// `read_hands` reads once the objects are known. `folder`: where the scene lies. Mistakes of form
/// are noted in the maps; the error is of an arm's file, or that the reader knows of one arm alone.
/// Real-time: never from the servo thread.
driver::Result<void> read_arms(YamlMap& root, const std::filesystem::path& folder,
                               const SceneReading& reading, std::vector<YamlMap>& arms,
                               Scene& scene);

/// Reads the hands of the arms that `read_arms` read. Precondition: the scene's objects are read.
/// `folder`: the scene's. Real-time: never from the servo thread.
void read_hands(std::vector<YamlMap>& arms, const std::filesystem::path& folder, Scene& scene);

}  // namespace thimble::scene
