#include <CLI/CLI.hpp>
#include <cstddef>
#include <string>

#include "cli/commands.h"
#include "cli/parts/part.h"
#include "cli/report_error.h"

namespace thimble::cli {

void add_absent_command(CLI::App& app, int& exit_code, const std::string& name,
                        const std::string& about, const Part& part) {
  if (about.empty()) return;
  const auto program = part_program(part);
  const bool packaged = *part.package != 0;
  if (!program.empty()) {
    CLI::App* command = app.add_subcommand(name, about);
    command->prefix_command();
    command->set_help_flag();  // the part's program prints the help
    command->footer("See " + std::string(part.package) + "(1).");
    // Before this program checks its options and opens the log.
    command->preparse_callback([program](std::size_t) {
      throw CLI::RuntimeError(start_part(program).message, kExitTrouble);
    });
    return;
  }
  CLI::App* command =
      app.add_subcommand(name, about + (packaged ? " (package " + std::string(part.package) + ")"
                                                 : std::string(" (not in this build)")));
  command->prefix_command();
  command->callback([name, part, packaged, &exit_code] {
    exit_code =
        report_error({"`thimble " + name + "` is not " +
                      (packaged ? "installed: " : "in this build: ") + how_to_get(part) + "."},
                     kExitBadInput);
  });
}

}  // namespace thimble::cli
