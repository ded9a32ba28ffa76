#pragma once

#include "cli/exit_code.h"
#include "thimble/driver/result.h"

namespace thimble::cli {

/// Prints and logs the error that ends a command, and returns `exit_code`. Real-time: never from
/// the servo thread.
ExitCode report_error(const driver::Error& error, ExitCode exit_code);

}  // namespace thimble::cli
