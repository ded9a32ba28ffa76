// In place of `thimble shot` in a build without THIMBLE_VIEW.
#include "cli/commands.h"

namespace thimble::cli {

void add_shot_command(CLI::App& app, int& exit_code) {
  add_absent_command(app, exit_code, "shot", "Draw a moment of a scene", "THIMBLE_VIEW");
}

}  // namespace thimble::cli
