// `thimble`: the commands of commands.inc. Parts with a separate program have their commands there
// (parts/).
#include <cstdio>

#include "cli/commands.h"
#include "cli/parts/part.h"
#include "cli/parts/program.h"
#include "cli/report_error.h"
#include "log/printed_text.h"
#include "share/viewer_process.h"

namespace {

/// Opens the start window on a desktop where the window is installed; otherwise returns.
void open_start_window() {
  using namespace thimble::cli;
  const auto viewer = part_program(kViewer);
  if (viewer.empty() || !thimble::session::has_display()) return;
  thimble::scene::print_format("The start window opens. For the commands: thimble --help\n");
  std::fflush(stdout);
  static char words[3][8] = {"thimble", "view", "--start"};
  static char* arguments[] = {words[0], words[1], words[2], nullptr};
  keep_arguments(arguments);
  report_error(start_part(viewer), kExitTrouble);
}

}  // namespace

int main(int argc, char** argv) {
  using namespace thimble::cli;
  return run_program(argc, argv,
                     {.name = "thimble",
                      .about = "feel virtual objects through a force-feedback arm",
                      .commands =
                          {
#define THIMBLE_COMMAND(function, part, name, about) add_##function##_command,
#define THIMBLE_SUBCOMMAND(function, part, name, about)
#include "cli/commands.inc"
#undef THIMBLE_COMMAND
#undef THIMBLE_SUBCOMMAND
                          },
                      .without_arguments = open_start_window});
}
