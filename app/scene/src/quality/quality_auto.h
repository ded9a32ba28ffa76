#pragma once

#include <optional>
#include <string>
#include <vector>

#include "thimble/scene/scene_file.h"

namespace thimble::scene {

/// Chooses the best point of the stored diagrams (quality_table.h) for each object of a scene, over
/// all settings that the scene leaves open. Without a budget it is the cheapest point with errors
/// below perception. With a budget (ns per tick, for all objects) it is the point with the smallest
/// largest error. Returns a sentence per object and one about the total. Real-time: never from the
/// servo thread.
std::vector<std::string> choose_quality(Scene& scene, std::optional<double> budget);

/// Returns whether the rendering of an object's surface is left open.
bool leaves_surface_open(const SceneObject& object);

}  // namespace thimble::scene
