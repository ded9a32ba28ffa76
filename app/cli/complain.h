#pragma once

#include "cli/exit_code.h"
#include "thimble/driver/result.h"

namespace thimble::cli {

/// Says on the terminal and in the log what keeps a command from going on, and returns `exit_code`
/// for it to end with. Real-time: never from the servo thread.
ExitCode complain(const driver::Error& error, ExitCode exit_code);

}  // namespace thimble::cli
