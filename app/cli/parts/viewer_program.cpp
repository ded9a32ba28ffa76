// `thimble-viewer`: the commands of the package of that name, which `thimble` starts.
#include "cli/commands.h"
#include "cli/parts/program.h"

int main(int argc, char** argv) {
  using namespace thimble::cli;
  return run_program(argc, argv,
                     {.name = "thimble-viewer",
                      .about = "show runs in a window and in pictures",
                      .commands = {add_shot_command, add_window_command}});
}
