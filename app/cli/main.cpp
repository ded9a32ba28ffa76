#include <sys/stat.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <sstream>
#include <string>
#include <utility>

#include "cli/commands.h"
#include "cli/complain.h"
#include "cli/exit_code.h"
#include "cli/log_options.h"
#include "cli/usage/usage_error.h"
#include "log/console.h"
#include "log/logger.h"
#include "log/printed_text.h"
#include "output/standard_streams.h"
#include "signals.h"
#include "thimble/scene/build_info.h"

namespace {

constexpr const char* kFooter =
    "Exit codes: 0 done, 1 unexpected trouble, 2 wrong arguments or input, 3 no arm,\n"
    "4 the force went off with a fault, 5 a figure, a fit or a check misses its goal or did not "
    "run,\n"
    "130 ended early by Ctrl-C or SIGTERM.\n"
    "A physical arm moves by itself: keep clear of it, and keep its power switch at hand.";

int run(int argc, char** argv) {
  CLI::App app("Thimble makes virtual objects touchable.", "thimble");
  const thimble::scene::BuildInfo build = thimble::scene::build_info();
  app.set_version_flag("--version", "thimble " + std::string(build.version) + " (" +
                                        std::string(build.type) + ", " +
                                        std::string(build.compiler) + ")");
  app.require_subcommand(1);
  app.footer(kFooter);
  int exit_code = thimble::cli::kExitDone;
#define THIMBLE_COMMAND(function, part, name, about) \
  thimble::add_##function##_command(app, exit_code);
#define THIMBLE_SUBCOMMAND(function, part, name, about)
#include "cli/commands.inc"
#undef THIMBLE_COMMAND
#undef THIMBLE_SUBCOMMAND
  std::string command_line;
  for (int i = 1; i < argc; ++i) command_line.append(i == 1 ? "" : " ").append(argv[i]);
  thimble::cli::add_log_options(app, command_line);
  for (CLI::App* command : app.get_subcommands({})) {
    command->set_version_flag("--version", app.version());
  }
  thimble::cli::check_numbers(app);
  thimble::cli::check_texts(app);
  if (argc <= 1) {
    thimble::scene::print_format("%s", app.help().c_str());
    return thimble::cli::kExitDone;
  }
  try {
    auto words = thimble::cli::without_separator(app, {argv + 1, argv + argc});
    std::reverse(words.begin(), words.end());  // as the library takes them
    app.parse(std::move(words));
  } catch (const CLI::Success& stop) {  // --help, --version, --list
    std::ostringstream out, wrong;
    app.exit(stop, out, wrong);
    thimble::scene::write_text(stdout, out.str());
    return thimble::cli::kExitDone;
  } catch (const CLI::ParseError& error) {
    return thimble::cli::complain({thimble::cli::usage_error(app, error)},
                                  thimble::cli::kExitBadInput);
  }
  return exit_code;
}

/// Returns the exit code of a program that has printed all it had to, or that of trouble if what it
/// printed is lost. A reader that has gone (`| head`) has seen all it wanted.
int with_output(int exit_code) {
  const bool lost = std::fflush(stdout) != 0 || std::ferror(stdout) != 0;
  struct stat output {};
  const bool closed = fstat(STDOUT_FILENO, &output) != 0;
  if (!lost || closed || S_ISFIFO(output.st_mode) || S_ISSOCK(output.st_mode)) return exit_code;
  thimble::scene::logger().error(
      "What was to be printed could not be written: is the disk full that it goes to?");
  return exit_code == thimble::cli::kExitDone ? thimble::cli::kExitTrouble : exit_code;
}

}  // namespace

int main(int argc, char** argv) {
  if (!thimble::output::open_standard_streams()) return thimble::cli::kExitTrouble;
  thimble::scene::outlive_trouble_with_files();
  // Every exception ends here, so that destructors run and the arm is left with zero force.
  try {
    return with_output(run(argc, argv));
  } catch (const std::exception& trouble) {
    thimble::scene::logger().critical("unexpected trouble: {}", trouble.what());
  } catch (...) {
    thimble::scene::logger().critical("unexpected trouble.");
  }
  return thimble::cli::kExitTrouble;
}
