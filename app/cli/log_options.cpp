#include "cli/log_options.h"

#include <memory>

#include "cli/options/old_names.h"
#include "log/logger.h"
#include "log/progress.h"
#include "thimble/scene/build_info.h"

namespace thimble::cli {
namespace {

struct LogOptions {
  int more = 0;
  bool quiet = false;
  bool progress = false, no_progress = false;  // neither: shown at a terminal
  std::string file;

  scene::Verbosity verbosity() const {
    if (quiet) return scene::Verbosity::kQuiet;
    return more == 0   ? scene::Verbosity::kNormal
           : more == 1 ? scene::Verbosity::kDebug
                       : scene::Verbosity::kTrace;
  }
  scene::ProgressChoice progress_choice() const {
    if (progress) return scene::ProgressChoice::kAlways;
    return no_progress || quiet ? scene::ProgressChoice::kNever
                                : scene::ProgressChoice::kIfTerminal;
  }
};

/// Makes commands pass options that they do not know to the program.
void fall_through(CLI::App& above) {
  for (CLI::App* command : above.get_subcommands([](const CLI::App*) { return true; })) {
    if (command->get_prefix_command()) continue;  // it passes all words to another program
    command->fallthrough();
    fall_through(*command);
  }
}

}  // namespace

void add_log_options(CLI::App& program, const std::string& command_line) {
  auto options = std::make_shared<LogOptions>();
  program.add_flag("-v,--verbose", options->more,
                   "Print the log on the terminal; -vv: every event");
  program.add_flag("-q,--quiet", options->quiet, "Print errors only")->excludes("--verbose");
  CLI::Option* const progress =
      program.add_flag("--progress", options->progress, "Show progress (default: at a terminal)");
  program.add_flag("--no-progress", options->no_progress, "Never show progress")
      ->excludes(progress);
  program.add_option("--log", options->file, "Log file (default: see `thimble doctor`)")
      ->option_text("FILE");
  fall_through(program);
  program.parse_complete_callback([options, command_line, &program] {
    const auto begun = scene::begin_log({.verbosity = options->verbosity(),
                                         .file = options->file,
                                         .heading = scene::program_name() + ": " + command_line});
    if (!begun) throw CLI::ValidationError("--log", begun.error().message);
    scene::choose_progress(options->progress_choice());
    warn_of_old_names(program);
  });
}

}  // namespace thimble::cli
