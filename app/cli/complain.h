#pragma once

#include <cstdio>

#include "cli/exit_code.h"
#include "thimble/driver/result.h"

namespace thimble::app {

/// Says on stderr what keeps a command from going on, and returns `exit_code` for it to end with.
/// Real-time: never from the servo thread.
inline ExitCode complain(const driver::Error& error, ExitCode exit_code) {
  std::fprintf(stderr, "thimble: %s\n", error.message.c_str());
  return exit_code;
}

}  // namespace thimble::app
