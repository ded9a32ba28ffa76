#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "report/figure.h"
#include "thimble/driver/result.h"

namespace thimble::app {

/// Measures what accuracy costs: one diagram per axis named (all, if none is), as pictures, tables
/// and one page in `folder`, which exists. `count`: whether instructions are counted as well, which
/// takes minutes. Fails if an axis is not known or a file cannot be
/// written. Real-time: never from the servo thread.
driver::Result<std::vector<Figure>> study_accuracy(const std::vector<std::string>& axes, bool count,
                                                   const std::filesystem::path& folder);

}  // namespace thimble::app
