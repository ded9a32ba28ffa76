#pragma once

#include <functional>
#include <string>
#include <vector>

// The argument library; its header is slow to compile.
namespace CLI {
class App;
}

namespace thimble::session {
class RunAttachment;
}

namespace thimble::cli {

/// Opens windows in a theme (light or dark) until the user closes them, or for the given seconds if
/// they are above 0, and returns the exit code; empty in a program without windows.
struct ShowWindow {
  std::function<int(session::RunAttachment& runs, double seconds, const std::string& theme)> runs;
  std::function<int(const std::vector<std::string>& files, double seconds,
                    const std::string& theme)>
      recordings;
  /// Opens the start window, with a file or the name of a scene selected if `open` is not empty.
  std::function<int(const std::string& open, double seconds, const std::string& theme)> start;
};

// One function per command of the program (commands.inc). Each adds its sub-command with options
// and help to `app`. The command writes its exit code (exit_code.h) to `exit_code`.
#define THIMBLE_COMMAND(function, part, name, about) \
  void add_##function##_command(CLI::App& app, int& exit_code);
#define THIMBLE_SUBCOMMAND THIMBLE_COMMAND
#include "cli/commands.inc"
#undef THIMBLE_COMMAND
#undef THIMBLE_SUBCOMMAND

/// `thimble view RUN`: shows a run of another process, by `show_window` or as text, or a recording.
void add_view_command(CLI::App& app, int& exit_code, const ShowWindow& show_window);
/// Returns whether `thimble view` has a window; the package thimble-viewer adds it.
bool has_window();
/// `thimble study stability`: measures the region of stable walls.
void add_stability_options(CLI::App& command, int& exit_code);
/// `thimble study trouble`: touches random scenes.
void add_trouble_options(CLI::App& command, int& exit_code);
/// `thimble study accuracy`: measures accuracy and computing time.
void add_accuracy_options(CLI::App& command, int& exit_code);
/// `thimble study gating SCENE`: finds effects that a scene does not need.
void add_gating_options(CLI::App& command, int& exit_code);

/// `thimble manual`: prints the manual page of a program, for the installation. `name`: name of the
/// page; `about`: purpose of the program.
void add_manual_command(CLI::App& app, int& exit_code, const std::string& name,
                        const std::string& about);

struct Part;

/// Adds a command of a part that this program lacks. If the part's program is installed, it gets
/// the command line; otherwise the command prints how to get the part. A command without `about` is
/// not added.
void add_absent_command(CLI::App& app, int& exit_code, const std::string& name,
                        const std::string& about, const Part& part);

}  // namespace thimble::cli
