#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/parts/part.h"
#include "cli/report_error.h"
#include "output/output_plan.h"
#include "view/playback/recording_view.h"
#include "view/start/follow_window.h"
#include "view/start/start_window.h"
#include "view/window.h"

namespace thimble::cli {
namespace {

view::Theme theme_named(const std::string& name) {
  return name == "dark" ? view::Theme::kDark : view::Theme::kLight;
}

}  // namespace

void add_window_command(CLI::App& app, int& exit_code) {
  auto choice = std::make_shared<view::WindowChoice>();
  auto follow = std::make_shared<view::FollowSetup>();
  ShowWindow show;
  show.runs = [choice, follow](session::RunAttachment& runs, double seconds,
                               const std::string& theme) -> int {
    choice->seconds = seconds;
    choice->theme = theme_named(theme);
    output::OutputPlan plan;
    plan.write("--picture", choice->last_picture, output::kPng);
    if (auto begun = plan.begin(); !begun) return report_error(begun.error(), kExitBadInput);
    if (follow->again.size() == 1) {
      return report_error({"--run-again: expected `run`, a scene and options, one word each."},
                          kExitBadInput);
    }
    follow->thimble = main_program();
    const auto shown = view::show_window(runs, *follow, *choice);
    return shown ? kExitDone : report_error(shown.error(), kExitTrouble);
  };
  show.recordings = [choice](const std::vector<std::string>& files, double seconds,
                             const std::string& theme) -> int {
    choice->seconds = seconds;
    choice->theme = theme_named(theme);
    if (choice->felt.sound || choice->felt.rumble) {
      return report_error(
          {"--sound and --rumble require a run. For the sound of a recording, use `thimble "
           "export FILE --sound FILE.wav`."},
          kExitBadInput);
    }
    output::OutputPlan plan;
    for (const std::string& file : files) plan.read(file);
    plan.write("--picture", choice->last_picture, output::kPng);
    if (auto begun = plan.begin(); !begun) return report_error(begun.error(), kExitBadInput);
    const auto recording = view::RecordingView::open({files.begin(), files.end()});
    if (!recording) return report_error(recording.error(), kExitBadInput);
    const auto shown = view::show_recording(**recording, files.front(), *choice);
    return shown ? kExitDone : report_error(shown.error(), kExitTrouble);
  };
  show.start = [choice](const std::string& open, double seconds, const std::string& theme) -> int {
    choice->seconds = seconds;
    choice->theme = theme_named(theme);
    const auto thimble = main_program();
    if (thimble.empty()) {
      return report_error({"The program thimble is missing beside thimble-viewer. Install the "
                           "package thimble again."},
                          kExitTrouble);
    }
    output::OutputPlan plan;
    plan.write("--picture", choice->last_picture, output::kPng);
    if (auto begun = plan.begin(); !begun) return report_error(begun.error(), kExitBadInput);
    const auto shown = view::show_start_window({.thimble = thimble, .open = open}, *choice);
    return shown ? kExitDone : report_error(shown.error(), kExitTrouble);
  };
  add_view_command(app, exit_code, show);
  CLI::App* command = app.get_subcommand("view");
  constexpr const char* kWindow = "Window";
  command
      ->add_option_function<std::string>(
          "--hand",
          [choice](const std::string& name) {
            choice->hand = view::hand_source_named(name).value_or(choice->hand);
          },
          "Input that moves the hand of the run (default mouse)")
      ->check(CLI::IsMember(
          std::vector<std::string>(view::kHandSources.begin(), view::kHandSources.end())))
      ->excludes("--text")
      ->group(kWindow);
  command->add_flag("--sound", choice->felt.sound, "Play the contact as sound")
      ->excludes("--text")
      ->group(kWindow);
  command->add_flag("--rumble", choice->felt.rumble, "Play the contact as rumble of a gamepad")
      ->excludes("--text")
      ->group(kWindow);
  // Internal: `thimble run --view` adds it (run_again_words).
  command
      ->add_option("--run-again", follow->again,
                   "A word of the arguments of thimble by which Restart starts an ended run")
      ->take_all()
      ->allow_extra_args(false)
      ->excludes("--text")
      ->group("");
  command->add_option("--at", choice->at, "Time at which a recording is first shown, s")
      ->check(CLI::Range(0.0, 86400.0))
      ->group(kWindow);
  command
      ->add_option("--ui-scale", choice->ui_scale,
                   "Scale of text and panel (default: the monitor's)")
      ->check(CLI::Range(0.75, 3.0))
      ->excludes("--text")
      ->group(kWindow);
  command
      ->add_option("--picture", choice->last_picture,
                   "Write a PNG of the window at the end of --for")
      ->option_text("FILE")
      ->needs("--for")
      ->excludes("--text")
      ->group(kWindow);
}

bool has_window() {
  return true;
}

}  // namespace thimble::cli
