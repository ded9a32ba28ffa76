#include "cli/options/old_names.h"

#include "log/logger.h"

namespace thimble::cli {

void warn_of_old_names(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_group() != kOldNames || option->count() == 0) continue;
    scene::logger().warn("{} is deprecated; use {}.", option->get_name(),
                         option->get_description());
  }
  for (const CLI::App* below : command.get_subcommands()) warn_of_old_names(*below);
}

}  // namespace thimble::cli
