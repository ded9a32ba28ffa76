#include <CLI/CLI.hpp>
#include <memory>

#include "cli/commands.h"
#include "cli/complain.h"
#include "view/window.h"

namespace thimble::app {

void add_window_command(CLI::App& app, int& exit_code) {
  auto choice = std::make_shared<view::WindowChoice>();
  add_view_command(app, exit_code, [choice](session::RunAttachment& runs, double seconds) {
    choice->seconds = seconds;
    const auto shown = view::show_window(runs, *choice);
    return shown ? static_cast<int>(kExitDone) : complain(shown.error(), kExitTrouble);
  });
  CLI::App* command = app.get_subcommand("view");
  command->add_option("--picture", choice->last_picture, "PNG of the window to write then")
      ->needs("--for")
      ->excludes("--text");
}

bool has_window() {
  return true;
}

}  // namespace thimble::app
