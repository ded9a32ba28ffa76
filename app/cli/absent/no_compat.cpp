// In place of `thimble exec` in a program without THIMBLE_COMPAT.
#include "cli/commands.h"

namespace thimble::cli {

void add_exec_command(CLI::App& app, int& exit_code) {
  add_absent_command(app, exit_code, "exec",
                     "Run a program that was written for another maker's arm", "THIMBLE_COMPAT");
}

}  // namespace thimble::cli
