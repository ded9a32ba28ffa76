#pragma once

#include <filesystem>

#include "thimble/driver/result.h"
#include "thimble/session/run_figures.h"

namespace thimble::report {

/// Writes report.json and figures.json into the folder, which is made if need be. Fails, naming the
/// file, if that cannot be done. Real-time: never from the servo thread.
driver::Result<void> write_report(const session::RunFigures& report,
                                  const std::filesystem::path& folder);

}  // namespace thimble::report
