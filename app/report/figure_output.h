#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "thimble/driver/result.h"
#include "thimble/session/run_figures.h"

namespace thimble::report {

using session::Figure;

/// Writes figures as JSON: a list of {"name", "value", "unit", "goal", "met", "note"}. "goal" and
/// "met" are omitted without a goal, "note" without a note. Fails if the file cannot be written.
driver::Result<void> write_figures(const std::vector<Figure>& figures,
                                   const std::filesystem::path& file);

/// Returns figures as a text table, one per line.
std::string figure_table(const std::vector<Figure>& figures);

/// Returns one line with every figure that misses its goal, and where it was measured; empty if all
/// goals are met.
std::string unmet_line(const std::vector<Figure>& figures);

/// Writes a whole file. The error names the file.
driver::Result<void> write_text(const std::string& text, const std::filesystem::path& file);

}  // namespace thimble::report
