#pragma once

#include <filesystem>
#include <vector>

#include "report/figure_output.h"
#include "thimble/driver/result.h"

namespace thimble::studies {

/// Measures what each integrator of bodies costs per tick of 1 ms and how wrong it is: on a poked
/// membrane against its exact motion, and on a scanned mesh against a far finer step. Writes
/// integrators.csv and a work-precision diagram of each. Without the scanned mesh its part is left
/// out, and said so. Real-time: never from the servo thread.
driver::Result<std::vector<session::Figure>> study_integrators(const std::filesystem::path& folder);

}  // namespace thimble::studies
