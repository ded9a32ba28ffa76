// `thimble`: the commands of commands.inc. Parts with a separate program have their commands there
// (parts/).
#include "cli/commands.h"
#include "cli/parts/program.h"

int main(int argc, char** argv) {
  using namespace thimble::cli;
  return run_program(argc, argv,
                     {.name = "thimble",
                      .about = "feel virtual objects through a force-feedback arm",
                      .commands = {
#define THIMBLE_COMMAND(function, part, name, about) add_##function##_command,
#define THIMBLE_SUBCOMMAND(function, part, name, about)
#include "cli/commands.inc"
#undef THIMBLE_COMMAND
#undef THIMBLE_SUBCOMMAND
                      }});
}
