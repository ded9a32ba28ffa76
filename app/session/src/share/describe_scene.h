#pragma once

#include <string>
#include <vector>

#include "share/shared_scene.h"
#include "thimble/driver/export.h"
#include "thimble/scene/arm_file.h"
#include "thimble/scene/scene_file.h"
#include "thimble/scene/scene_objects.h"

namespace thimble::session {

/// Returns the description of an arm for drawing. Real-time: never from the servo thread.
SharedScene::Arm describe_arm(const scene::ArmFile& arm, const std::string& device);

/// Returns the description of a loaded scene for drawing, without knobs. `device` is "sim" or the
/// name of the real arm. Real-time: never from the servo thread.
SharedScene describe_scene(const scene::Scene& scene, const scene::SceneObjects& objects,
                           const std::string& device);

/// As above, with all arms of the scene; `devices` has one entry per arm, in order.
THIMBLE_EXPORT SharedScene describe_scene(const scene::Scene& scene,
                                          const scene::SceneObjects& objects,
                                          const std::vector<std::string>& devices);

}  // namespace thimble::session
