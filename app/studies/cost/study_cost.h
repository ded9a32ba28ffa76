#pragma once

#include <filesystem>
#include <vector>

#include "report/figure_output.h"
#include "thimble/driver/result.h"

namespace thimble::studies {

/// Measures what each way of contact and each effect costs per tick, and what it buys: the error of
/// the force against the analytic surface, or the force that is missing without the effect. Writes
/// cost.csv and two pictures; memory against time as the paper offers it is in the figures.
/// Instructions are counted where valgrind is installed. Real-time: never from the servo thread.
driver::Result<std::vector<session::Figure>> study_cost(const std::filesystem::path& folder);

}  // namespace thimble::studies
