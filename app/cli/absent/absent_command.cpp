#include <CLI/CLI.hpp>
#include <string>

#include "cli/commands.h"
#include "cli/complain.h"

namespace thimble::cli {

void add_absent_command(CLI::App& app, int& exit_code, const std::string& name,
                        const std::string& about, const std::string& part) {
  if (about.empty()) return;
  CLI::App* command = app.add_subcommand(name, about + " (not in this build)");
  command->prefix_command();
  const std::string option = part.empty() ? "" : " (CMake: " + part + "=ON)";
  command->callback([name, option, &exit_code] {
    exit_code = complain({"This thimble was built without `" + name + "`" + option +
                          ". app/setup.sh release thimble builds the whole program: "
                          "build/release/app/thimble."},
                         kExitBadInput);
  });
}

}  // namespace thimble::cli
