#pragma once

#include <filesystem>
#include <vector>

#include "studies/stability/stability_tables.h"
#include "thimble/driver/result.h"

namespace thimble::studies {

/// Draws all pictures of the study from the tables in `folder` (write_stability_tables). Fails if
/// gnuplot does. Real-time: never from the servo thread.
driver::Result<void> draw_stability(const StabilitySetup& setup,
                                    const std::vector<StabilityRow>& rows,
                                    const std::filesystem::path& folder);

}  // namespace thimble::studies
