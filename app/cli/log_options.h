#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace thimble::cli {

/// Adds the options -v, --quiet, --progress and --log to the program; they are accepted before and
/// after any command. Logging begins after they are parsed and before a command runs.
/// `command_line` is the first line of the log.
void add_log_options(CLI::App& program, const std::string& command_line);

}  // namespace thimble::cli
