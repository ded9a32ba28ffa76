#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/parts/part.h"
#include "cli/report_error.h"
#include "log/logger.h"
#include "output/output_plan.h"
#include "view/compare/recorded_runs.h"
#include "view/start/follow_window.h"
#include "view/start/start_window.h"
#include "view/window.h"

namespace thimble::cli {
namespace {

view::Theme theme_named(const std::string& name) {
  return name == "dark" ? view::Theme::kDark : view::Theme::kLight;
}

/// Options of recordings on one time line.
struct CompareOptions {
  std::vector<std::string> signals;
  std::string scene_of;

  /// Fails if any is used without a recording.
  driver::Result<void> check_unused() const {
    if (signals.empty() && scene_of.empty()) return {};
    return driver::Error{std::string(signals.empty() ? "--scene-of" : "--signals") +
                         " requires a recording: `thimble view FILE.h5`."};
  }
};

/// Shows recordings and signals in a window, and returns the exit code.
int show_recorded(const std::vector<std::string>& files, const CompareOptions& compare,
                  const view::WindowChoice& choice) {
  for (const std::string& file : files) {
    if (std::filesystem::path(file).extension() != ".csv") continue;
    return report_error(
        {file + " is no recording. To plot its columns, use --signals " + file + "."},
        kExitBadInput);
  }
  output::OutputPlan plan;
  for (const std::string& file : files) plan.read(file);
  for (const std::string& file : compare.signals) plan.read(file);
  plan.write("--picture", choice.last_picture, output::kPng);
  if (auto begun = plan.begin(); !begun) return report_error(begun.error(), kExitBadInput);
  const auto runs =
      view::RecordedRuns::open({.recordings = {files.begin(), files.end()},
                                .signals = {compare.signals.begin(), compare.signals.end()},
                                .scene_of = compare.scene_of});
  if (!runs) return report_error(runs.error(), kExitBadInput);
  for (const std::string& warning : (*runs)->warnings()) scene::logger().warn("{}", warning);
  // The panel of one recording has more about it.
  const bool alone = (*runs)->size() == 1 && compare.signals.empty();
  const auto shown =
      alone ? view::show_recording((*runs)->run(0), files.front(), choice)
            : view::show_recordings(**runs, std::filesystem::path(files.front()).stem(), choice);
  return shown ? kExitDone : report_error(shown.error(), kExitTrouble);
}

}  // namespace

void add_window_command(CLI::App& app, int& exit_code) {
  auto choice = std::make_shared<view::WindowChoice>();
  auto compare = std::make_shared<CompareOptions>();
  auto follow = std::make_shared<view::FollowSetup>();
  ShowWindow show;
  show.runs = [choice, follow, compare](session::RunAttachment& runs, double seconds,
                                        const std::string& theme) -> int {
    choice->seconds = seconds;
    choice->theme = theme_named(theme);
    if (auto unused = compare->check_unused(); !unused) {
      return report_error(unused.error(), kExitBadInput);
    }
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
  show.recordings = [choice, compare](const std::vector<std::string>& files, double seconds,
                                      const std::string& theme) -> int {
    choice->seconds = seconds;
    choice->theme = theme_named(theme);
    if (choice->felt.sound || choice->felt.rumble) {
      return report_error(
          {"--sound and --rumble require a run. For the sound of a recording, use `thimble "
           "export FILE --sound FILE.wav`."},
          kExitBadInput);
    }
    return show_recorded(files, *compare, *choice);
  };
  show.start = [choice, compare](const std::string& open, double seconds,
                                 const std::string& theme) -> int {
    choice->seconds = seconds;
    choice->theme = theme_named(theme);
    if (auto unused = compare->check_unused(); !unused) {
      return report_error(unused.error(), kExitBadInput);
    }
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
      ->add_option("--signals", compare->signals,
                   "Plot a CSV file `time,name [unit],...` with a recording; time 0 is the first "
                   "tick. May be repeated")
      ->option_text("FILE")
      ->take_all()
      ->allow_extra_args(false)
      ->excludes("--text")
      ->group(kWindow);
  command
      ->add_option("--scene-of", compare->scene_of,
                   "Recording whose scene is drawn, if scenes differ (default: the first)")
      ->option_text("FILE")
      ->excludes("--text")
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
