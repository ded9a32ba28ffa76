#pragma once

#include <functional>
#include <string>
#include <vector>

// The argument library, which takes seconds to read.
namespace CLI {
class App;
}

namespace thimble::session {
class RunAttachment;
}

namespace thimble::cli {

/// Opens windows until they are closed, or for so many seconds if they are above 0, and gives the
/// exit code; empty where there are none.
struct ShowWindow {
  std::function<int(session::RunAttachment& runs, double seconds)> runs;
  std::function<int(const std::vector<std::string>& files, double seconds)> recordings;
};

// One function per command of the program (commands.inc). Each adds its sub-command with options
// and help to `app`; when the user chose it, its exit code (exit_code.h) is left in `exit_code`.
#define THIMBLE_COMMAND(function, part, name, about) \
  void add_##function##_command(CLI::App& app, int& exit_code);
#define THIMBLE_SUBCOMMAND THIMBLE_COMMAND
#include "cli/commands.inc"
#undef THIMBLE_COMMAND
#undef THIMBLE_SUBCOMMAND

/// `thimble view RUN`: shows a run that goes on in another process, by `show_window` or as text, or
/// a recording.
void add_view_command(CLI::App& app, int& exit_code, const ShowWindow& show_window);
/// Returns whether `thimble view` has a window: without the package thimble-viewer it has none.
bool has_window();
/// `thimble study stability`: measures where walls are stable.
void add_stability_options(CLI::App& command, int& exit_code);
/// `thimble study trouble`: touches random scenes.
void add_trouble_options(CLI::App& command, int& exit_code);
/// `thimble study accuracy`: what accuracy costs in time.
void add_accuracy_options(CLI::App& command, int& exit_code);
/// `thimble study gating SCENE`: which effects a scene could do without.
void add_gating_options(CLI::App& command, int& exit_code);

/// `thimble manual`: prints the manual page of a program, which the installation keeps. `name`: of
/// the page; `about`: what the program is for.
void add_manual_command(CLI::App& app, int& exit_code, const std::string& name,
                        const std::string& about);

struct Part;

/// Adds a command of a part that is not in this program. If the part's program is there, it gets
/// the command line; otherwise the command answers with how to get the part. One without `about` is
/// not added.
void add_absent_command(CLI::App& app, int& exit_code, const std::string& name,
                        const std::string& about, const Part& part);

}  // namespace thimble::cli
