#pragma once

#include <filesystem>
#include <vector>

#include "thimble/driver/export.h"

namespace thimble::scene {

/// Returns the files that the text of a scene names: itself, its arms, meshes, height maps and hand
/// paths. Used to reject outputs of a command that would overwrite an input. The scene need not be
/// valid; names without a file are omitted. Real-time: never from the servo thread.
THIMBLE_EXPORT std::vector<std::filesystem::path> scene_inputs(const std::filesystem::path& scene);

}  // namespace thimble::scene
