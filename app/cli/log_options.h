#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace thimble::cli {

/// Adds the options -v, --quiet and --log to the program, before or behind any of its commands, and
/// begins to log once they are known and before a command runs. `command_line` is what the log
/// names as its first line.
void add_log_options(CLI::App& program, const std::string& command_line);

}  // namespace thimble::cli
