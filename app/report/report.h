#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "thimble/driver/result.h"
#include "thimble/session/run_figures.h"

namespace thimble::report {

/// Returns the report of a run as JSON, as in report.json.
nlohmann::ordered_json report_json(const session::RunFigures& report);

/// Writes report.json and figures.json into the folder, which is created if necessary. The error
/// names the file. Real-time: never from the servo thread.
driver::Result<void> write_report(const session::RunFigures& report,
                                  const std::filesystem::path& folder);

}  // namespace thimble::report
