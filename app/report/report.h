#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "report/figure.h"
#include "thimble/driver/result.h"
#include "thimble/session/run_figures.h"

namespace thimble::app {

/// Returns the figures a run stands for, with their goals (DESIGN.md, Figures).
std::vector<Figure> figures_of(const session::RunFigures& report);

/// Tells a run in plain words, about ten lines, for somebody who sees it for the first time.
std::string summary(const session::RunFigures& report);

/// Writes report.json and figures.json into the folder, which is made if need be. Fails, naming the
/// file, if that cannot be done. Real-time: never from the servo thread.
driver::Result<void> write_report(const session::RunFigures& report,
                                  const std::filesystem::path& folder);

}  // namespace thimble::app
