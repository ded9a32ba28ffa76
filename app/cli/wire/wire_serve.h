#pragma once

#include <CLI/CLI.hpp>

namespace thimble::cli {

/// Adds `thimble wire serve`. Real-time: never from the servo thread.
void add_wire_serve_command(CLI::App& wire_command, int& exit_code);

}  // namespace thimble::cli
