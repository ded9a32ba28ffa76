#pragma once

#include "arm_file.h"
#include "scene_file.h"
#include "scene_objects.h"
#include "share/shared_scene.h"

namespace thimble::app {

/// Says of an arm what a viewer needs to draw it. Real-time: never from the servo thread.
SharedScene::Arm describe_arm(const ArmFile& arm, const std::string& device);

/// Says of a loaded scene what its viewers need to draw it; the knobs are left out. `device` is
/// "sim" or the name of the arm on the desk. Real-time: never from the servo thread.
SharedScene describe_scene(const Scene& scene, const SceneObjects& objects,
                           const std::string& device);

}  // namespace thimble::app
