#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cli/exit_code.h"
#include "report/figure_output.h"

namespace thimble::cli {

/// Writes a study's figures to figures.json in its folder and prints them as a table. Prints the
/// place of the file, `where_to_look`, and in the last line the unmet goals. Returns the exit code:
/// that of unmet figures, or of a file that could not be written. Real-time: never from the servo
/// thread.
ExitCode end_study(const std::vector<session::Figure>& figures, const std::filesystem::path& folder,
                   const std::string& where_to_look = {});

}  // namespace thimble::cli
