#pragma once

#include <filesystem>
#include <vector>

#include "report/figure_output.h"
#include "thimble/driver/result.h"

namespace thimble::studies {

/// Shows what friction does on an encoder with steps, and which friction cures it [PHYSICS 2.1,
/// 2.2]: a picture per friction, overview, friction.csv with delays of 0 to 3 ticks, and the
/// figures. Prints its table. See Study::run.
driver::Result<std::vector<session::Figure>> study_friction(const std::filesystem::path& folder);

}  // namespace thimble::studies
