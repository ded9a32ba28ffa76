#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "report/figure_output.h"

namespace thimble::report {

/// Returns figures as JSON, in the format of `write_figures`.
nlohmann::ordered_json figures_json(const std::vector<Figure>& figures);

}  // namespace thimble::report
