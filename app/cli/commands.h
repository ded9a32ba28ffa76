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
/// Returns whether this program has a window: what app/demo.sh builds has none.
bool has_window();
/// `thimble study stability`: measures where walls are stable.
void add_stability_study(CLI::App& study_command, int& exit_code);
/// `thimble study trouble`: touches random scenes.
void add_trouble_study(CLI::App& study_command, int& exit_code);
/// `thimble study accuracy`: what accuracy costs in time.
void add_accuracy_study(CLI::App& study_command, int& exit_code);
/// `thimble study gating SCENE`: which effects a scene could do without.
void add_gating_study(CLI::App& study_command, int& exit_code);

/// Adds a command that this program lacks: it is listed in the help, and answers with how to build
/// the whole program. `part` is the option of CMake that it belongs to, if there is one. One
/// without `about` is not added.
void add_absent_command(CLI::App& app, int& exit_code, const std::string& name,
                        const std::string& about, const std::string& part = {});

}  // namespace thimble::cli
