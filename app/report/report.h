#pragma once

#include <filesystem>

#include "thimble/driver/result.h"
#include "thimble/session/run_figures.h"

namespace thimble::report {

/// Writes report.json and figures.json into the folder, which is created if necessary. The error
/// names the file. Real-time: never from the servo thread.
driver::Result<void> write_report(const session::RunFigures& report,
                                  const std::filesystem::path& folder);

}  // namespace thimble::report
