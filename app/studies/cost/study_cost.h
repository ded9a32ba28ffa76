#pragma once

#include <filesystem>
#include <vector>

#include "report/figure_output.h"
#include "thimble/driver/result.h"

namespace thimble::studies {

/// Measures the cost per tick of each contact method and each effect, and its benefit: the error of
/// the force against the analytic surface, or the force that is missing without the effect. Writes
/// cost.csv and two pictures; memory against time, for the paper's alternatives, is in the figures.
/// Instructions are counted if valgrind is installed. Real-time: never from the servo thread.
driver::Result<std::vector<session::Figure>> study_cost(const std::filesystem::path& folder);

}  // namespace thimble::studies
