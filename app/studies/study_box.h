#pragma once

#include <filesystem>
#include <vector>

#include "report/figure_output.h"
#include "thimble/driver/result.h"

namespace thimble::studies {

/// Draws the paper's Fig. 2 from the force laws: the force over a square for both forms of the box.
/// Also measures the force at which a thin plate lets the tip through. Writes box.csv and a
/// picture. Real-time: never from the servo thread.
driver::Result<std::vector<session::Figure>> study_box(const std::filesystem::path& folder);

}  // namespace thimble::studies
