#pragma once

#include <filesystem>
#include <vector>

#include "report/figure_output.h"
#include "thimble/driver/result.h"

namespace thimble::studies {

/// Shows the behaviour of frictions on an encoder with steps, and which friction prevents limit
/// cycles [PHYSICS 2.1, 2.2]: a picture per friction, an overview, friction.csv with delays of 0 to
/// 3 ticks, and the figures. Prints its table. See Study::run.
driver::Result<std::vector<session::Figure>> study_friction(const std::filesystem::path& folder);

}  // namespace thimble::studies
