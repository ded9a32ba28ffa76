#pragma once

#include <optional>
#include <string>
#include <vector>

#include "thimble/scene/scene_file.h"

namespace thimble::scene {

/// Puts each object of a scene on the best point over all knobs that the scene leaves open, from
/// the stored diagrams (quality_table.h): without a budget the cheapest at which nothing wrong can
/// be felt; with one (ns per tick, of all objects) the one whose largest error is smallest. Returns
/// a sentence per object and one about the whole. Real-time: never from the servo thread.
std::vector<std::string> choose_quality(Scene& scene, std::optional<double> budget);

/// Returns whether an object leaves open how its surface is felt.
bool leaves_surface_open(const SceneObject& object);

}  // namespace thimble::scene
