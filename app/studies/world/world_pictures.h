#pragma once

#include <filesystem>

#include "studies/world/world_touches.h"
#include "thimble/driver/result.h"

namespace thimble::studies {

/// Draws seam.png, block.png and groove.png (and .svg) from the tables that `study_world` has
/// written into `folder`, and from the last ticks of the touches.
driver::Result<void> draw_world(const WorldTouches& touches, const std::filesystem::path& folder);

}  // namespace thimble::studies
