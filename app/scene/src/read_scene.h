#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/render/effect/effect_table.h"
#include "thimble/render/mesh/triangle_mesh.h"
#include "thimble/scene/arm_file.h"
#include "thimble/scene/scene_file.h"
#include "yaml/yaml_reader.h"

namespace thimble::scene {

/// Parts of an object that a program passes in addition to the text of its scene.
struct ObjectInMemory {
  std::shared_ptr<const render::TriangleMesh> mesh;  ///< Mesh; null: that of the text.
  std::vector<render::EffectPlan> effects;           ///< Effects in addition to those of the text.
};

/// Reads a scene from parsed YAML. `file` is the path of the scene, to which file names are
/// relative. `in_memory`: further parts of the objects, in their order; may be empty. Errors and
/// real-time safety: as `load_scene`.
driver::Result<Scene> read_scene(YamlFile& yaml, const std::filesystem::path& file,
                                 const SceneReading& reading,
                                 std::span<const ObjectInMemory> in_memory = {});

/// Reads a scene by `read` at the rate of `reading`, or at its own rate if it would be unstable at
/// a lower one (SceneReading::rate_factor). Real-time: never from the servo thread.
driver::Result<Scene> read_at_rate(
    const SceneReading& reading,
    const std::function<driver::Result<Scene>(const SceneReading&)>& read);

/// Reads an arm from parsed YAML. Errors and real-time safety: as `load_arm`.
THIMBLE_EXPORT driver::Result<ArmFile> read_arm(YamlFile& yaml);

}  // namespace thimble::scene
