#pragma once

#include <optional>

#include "thimble/scene/scene_file.h"
#include "yaml/yaml_reader.h"

namespace thimble::scene {

/// Reads `plane`, `sphere` or `box` of an object that stands at p_WO (m), turned by R_WO. Nothing
/// if the object has none of them. Mistakes are noted by `object`. Real-time: never from the servo
/// thread.
std::optional<SceneShape> read_shape(YamlMap& object, const Eigen::Matrix3d& R_WO,
                                     const Eigen::Vector3d& p_WO);

}  // namespace thimble::scene
