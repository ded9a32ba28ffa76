#pragma once

#include <filesystem>
#include <vector>

#include "studies/friction/friction_cases.h"
#include "thimble/driver/result.h"

namespace thimble::studies {

/// Draws one friction's stop as NAME.png and .svg: position and force around the stop, the tip's
/// limit cycle afterwards, and the spectrum of the force at rest. The numbers go to data/. Fails if
/// gnuplot is missing or a file cannot be written. Real-time: never from the servo thread.
driver::Result<void> draw_friction(const FrictionCase& which, const FrictionMeasures& found,
                                   const std::filesystem::path& folder);

/// Draws the force of all frictions around the stop next to each other as overview.png and .svg,
/// from the numbers that draw_friction wrote to data/. Real-time: never from the servo thread.
driver::Result<void> draw_friction_overview(const std::vector<FrictionMeasures>& found,
                                            const std::filesystem::path& folder);

}  // namespace thimble::studies
