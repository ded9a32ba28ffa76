#pragma once

#include <vector>

#include "share/shared_scene.h"
#include "thimble/scene/scene_file.h"

namespace thimble::session {

/// Finds the force of a scene's fields together on a tip that rests, at the points of a grid with
/// equal steps that covers where in the arm's workspace it is felt. Each field is built anew; those
/// that only damp have no force there. Nothing if the scene has no field or none that is felt.
/// Real-time: never from the servo thread.
std::vector<SharedScene::FieldSample> sample_fields(const scene::Scene& scene);

}  // namespace thimble::session
