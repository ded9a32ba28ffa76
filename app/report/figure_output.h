#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "thimble/driver/result.h"
#include "thimble/session/figure.h"

namespace thimble::report {

using session::Figure;

/// Writes figures as JSON: a list of {"name", "value", "unit", "goal", "met", "note"}; "goal" and
/// "met" are left out where there is no goal, "note" where there is none. Fails if the file cannot
/// be written.
driver::Result<void> write_figures(const std::vector<Figure>& figures,
                                   const std::filesystem::path& file);

/// Lays figures out as a table in text, one per line.
std::string figure_table(const std::vector<Figure>& figures);

/// Returns one line that names every figure that misses its goal, and where; empty if all are met.
std::string unmet_line(const std::vector<Figure>& figures);

/// Writes a whole file. Fails, naming it, if that cannot be done.
driver::Result<void> write_text(const std::string& text, const std::filesystem::path& file);

}  // namespace thimble::report
