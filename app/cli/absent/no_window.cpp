// In place of the window in a program without it: `thimble view` shows runs as text.
#include "cli/commands.h"

namespace thimble::cli {

void add_window_command(CLI::App& app, int& exit_code) {
  add_view_command(app, exit_code, {});
}

bool has_window() {
  return false;
}

}  // namespace thimble::cli
