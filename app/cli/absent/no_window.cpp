// The window is in the program thimble-viewer. Without it, `thimble view` shows runs as text and in
// a browser.
#include "cli/commands.h"
#include "cli/parts/part.h"

namespace thimble::cli {

void add_window_command(CLI::App& app, int& exit_code) {
  if (!has_window()) return add_view_command(app, exit_code, {});
  add_absent_command(app, exit_code, "view", "Show a run of another process, or a recording",
                     kViewer);
}

bool has_window() {
  return !part_program(kViewer).empty();
}

}  // namespace thimble::cli
