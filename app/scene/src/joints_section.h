#pragma once

#include <filesystem>

#include "thimble/scene/scene_file.h"
#include "yaml/yaml_reader.h"

namespace thimble::scene {

/// Reads `joints: [...]` and `collisions: {...}` of a scene whose objects have been read. Mistakes
/// are recorded in `root`. Real-time: never from the servo thread.
void read_joints(YamlMap& root, const std::filesystem::path& folder, Scene& scene);

}  // namespace thimble::scene
