#include "cli/parts/program.h"

#include <sys/stat.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <memory>
#include <sstream>
#include <string>
#include <utility>

#include "cli/commands.h"
#include "cli/exit_code.h"
#include "cli/log_options.h"
#include "cli/parts/part.h"
#include "cli/report_error.h"
#include "cli/usage/help_text.h"
#include "cli/usage/usage_error.h"
#include "log/console.h"
#include "log/logger.h"
#include "log/printed_text.h"
#include "output/standard_streams.h"
#include "signals.h"
#include "thimble/scene/build_info.h"

namespace thimble::cli {
namespace {

constexpr const char* kFooter =
    "Exit codes: 0 done, 1 unexpected error, 2 invalid arguments or input, 3 no arm,\n"
    "4 force switched off by a fault, 5 a result misses its goal or a check did not\n"
    "run, 130 interrupted by Ctrl-C or SIGTERM.\n"
    "A real arm moves by itself: keep clear of it, and keep its power switch within\n"
    "reach.";

int run(int argc, char** argv, const Program& program) {
  CLI::App app("Thimble lets you feel virtual objects through a force-feedback arm.", "thimble");
  app.formatter(std::make_shared<HelpFormatter>());
  const scene::BuildInfo build = scene::build_info();
  app.set_version_flag("--version", "thimble " + std::string(build.version) + " (" +
                                        std::string(build.type) + ", " +
                                        std::string(build.compiler) + ")");
  app.require_subcommand(1);
  app.footer(kFooter);
  int exit_code = kExitDone;
  for (const AddCommand add : program.commands) add(app, exit_code);
  add_manual_command(app, exit_code, program.name, program.about);
  std::string command_line;
  for (int i = 1; i < argc; ++i) command_line.append(i == 1 ? "" : " ").append(argv[i]);
  add_log_options(app, command_line);
  for (CLI::App* command : app.get_subcommands({})) {
    if (command->get_help_ptr() != nullptr) command->set_version_flag("--version", app.version());
  }
  check_numbers(app);
  check_texts(app);
  if (argc <= 1) {
    if (program.without_arguments != nullptr) program.without_arguments();
    scene::print_format("%s", app.help().c_str());
    return kExitDone;
  }
  try {
    auto words = without_separator(app, {argv + 1, argv + argc});
    std::reverse(words.begin(), words.end());  // the library takes them in reverse order
    app.parse(std::move(words));
  } catch (const CLI::Success& stop) {  // --help, --version, --list
    std::ostringstream out, wrong;
    app.exit(stop, out, wrong);
    scene::write_text(stdout, out.str());
    return kExitDone;
  } catch (const CLI::RuntimeError& error) {  // a part's program did not start
    return report_error({error.what()}, kExitTrouble);
  } catch (const CLI::ParseError& error) {
    return report_error({usage_error(app, error)}, kExitBadInput);
  }
  return exit_code;
}

/// Returns the exit code of a program that has printed all its output, or kExitTrouble if output
/// was lost. A closed reader (`| head`) is no error.
int with_output(int exit_code) {
  const bool lost = std::fflush(stdout) != 0 || std::ferror(stdout) != 0;
  struct stat output {};
  const bool closed = fstat(STDOUT_FILENO, &output) != 0;
  if (!lost || closed || S_ISFIFO(output.st_mode) || S_ISSOCK(output.st_mode)) return exit_code;
  scene::logger().error("Failed to write the output. Is the disk full?");
  return exit_code == kExitDone ? kExitTrouble : exit_code;
}

}  // namespace

int run_program(int argc, char** argv, const Program& program) {
  if (!output::open_standard_streams()) return kExitTrouble;
  scene::ignore_sigpipe_and_sigxfsz();
  keep_arguments(argv);
  // Catches every exception, so that destructors run and the arm is left with zero force.
  try {
    return with_output(run(argc, argv, program));
  } catch (const std::exception& trouble) {
    scene::logger().critical("unexpected error: {}", trouble.what());
  } catch (...) {
    scene::logger().critical("unexpected error.");
  }
  return kExitTrouble;
}

}  // namespace thimble::cli
