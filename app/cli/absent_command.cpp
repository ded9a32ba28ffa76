#include <CLI/CLI.hpp>
#include <string>

#include "cli/commands.h"
#include "cli/complain.h"

namespace thimble::app {

void add_absent_command(CLI::App& app, int& exit_code, const std::string& name,
                        const std::string& about) {
  CLI::App* command = app.add_subcommand(name, about + " (not in this build)");
  command->prefix_command();
  command->callback([name, &exit_code] {
    exit_code = complain({"This thimble was built for a first touch, without `" + name +
                          "`. Build the whole with app/setup.sh release thimble; it is "
                          "build/release/app/thimble then."},
                         kExitBadInput);
  });
}

}  // namespace thimble::app
