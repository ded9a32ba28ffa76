#include <CLI/CLI.hpp>
#include <memory>

#include "cli/commands.h"
#include "cli/complain.h"
#include "view/window.h"

namespace thimble::app {

void add_window_command(CLI::App& app, int& exit_code) {
  auto choice = std::make_shared<view::WindowChoice>();
  add_view_command(app, exit_code, [choice](session::RunAttachment& runs) {
    const auto shown = view::show_window(runs, *choice);
    return shown ? static_cast<int>(kExitDone) : complain(shown.error(), kExitTrouble);
  });
  CLI::App* command = app.get_subcommand("view");
  CLI::Option* seconds =
      command->add_option("--for", choice->seconds, "Close the window after so many seconds")
          ->check(CLI::Range(0.1, 86400.0));
  command->add_option("--picture", choice->last_picture, "PNG of the window to write then")
      ->needs(seconds);
}

bool has_window() {
  return true;
}

}  // namespace thimble::app
