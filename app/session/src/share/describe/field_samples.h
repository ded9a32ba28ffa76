#pragma once

#include <vector>

#include "share/shared_scene.h"
#include "thimble/scene/scene_file.h"

namespace thimble::session {

/// Returns the total force of a scene's fields on a resting tip, at the points of a regular grid.
/// The grid covers the part of the arm's workspace where a force is felt. Each field is built
/// separately; fields that only damp have no force at rest. Empty if the scene has no field, or
/// none that is felt. Real-time: never from the servo thread.
std::vector<SharedScene::FieldSample> sample_fields(const scene::Scene& scene);

}  // namespace thimble::session
