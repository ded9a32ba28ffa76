#pragma once

#include <string>
#include <vector>

#include "share/shared_scene.h"
#include "thimble/driver/export.h"
#include "thimble/scene/arm_file.h"
#include "thimble/scene/scene_file.h"
#include "thimble/scene/scene_objects.h"

namespace thimble::session {

/// Returns what a viewer needs to draw an arm. Real-time: never from the servo thread.
SharedScene::Arm describe_arm(const scene::ArmFile& arm, const std::string& device);

/// Returns what viewers need to draw a loaded scene; the knobs are left out. `device` is
/// "sim" or the name of the arm on the desk. Real-time: never from the servo thread.
SharedScene describe_scene(const scene::Scene& scene, const scene::SceneObjects& objects,
                           const std::string& device);

/// As above, with all arms of the scene; `devices` are theirs, in order. Precondition: one each.
THIMBLE_EXPORT SharedScene describe_scene(const scene::Scene& scene,
                                          const scene::SceneObjects& objects,
                                          const std::vector<std::string>& devices);

}  // namespace thimble::session
