#pragma once

#include <filesystem>
#include <vector>

#include "report/figure_output.h"
#include "thimble/driver/result.h"

namespace thimble::studies {

/// Touches two objects with one proxy and with a proxy each, whose forces are added: a seam of two
/// flush boxes, and a block on a table. Also presses a point and a ball into a groove. Writes
/// seam.csv, block.csv, groove.csv and a picture of each. Real-time: never from the servo thread.
driver::Result<std::vector<session::Figure>> study_world(const std::filesystem::path& folder);

}  // namespace thimble::studies
