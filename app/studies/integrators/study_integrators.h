#pragma once

#include <filesystem>
#include <vector>

#include "report/figure_output.h"
#include "thimble/driver/result.h"

namespace thimble::studies {

/// Measures the cost per tick of 1 ms and the error of each integrator of bodies: on a membrane
/// against its exact motion, and on a scanned mesh against a far finer step. Writes integrators.csv
/// and a work-precision diagram of each. Without the scanned mesh its part is omitted and a note is
/// printed. Real-time: never from the servo thread.
driver::Result<std::vector<session::Figure>> study_integrators(const std::filesystem::path& folder);

}  // namespace thimble::studies
