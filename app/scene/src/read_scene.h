#pragma once

#include <filesystem>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/scene/arm_file.h"
#include "thimble/scene/scene_file.h"
#include "yaml/yaml_reader.h"

namespace thimble::scene {

/// Reads a scene from parsed YAML. `file` is the path of the scene, to which file names are
/// relative. Errors and real-time safety: as `load_scene`.
driver::Result<Scene> read_scene(YamlFile& yaml, const std::filesystem::path& file,
                                 const SceneReading& reading);

/// Reads an arm from parsed YAML. Errors and real-time safety: as `load_arm`.
THIMBLE_EXPORT driver::Result<ArmFile> read_arm(YamlFile& yaml);

}  // namespace thimble::scene
