#pragma once

#include <filesystem>
#include <vector>

#include "thimble/driver/export.h"

namespace thimble::scene {

/// Returns the files that a scene is made of, as far as its text names them: itself, its arms,
/// meshes, height maps and hand paths. What it names need not be right, and names that are no files
/// are left out: an output of the same command must not be any of them. Real-time: never from the
/// servo thread.
THIMBLE_EXPORT std::vector<std::filesystem::path> scene_inputs(const std::filesystem::path& scene);

}  // namespace thimble::scene
