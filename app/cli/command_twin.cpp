#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>
#include <utility>

#include "cli/commands.h"
#include "cli/file_options.h"
#include "cli/options/old_names.h"
#include "cli/report_error.h"
#include "cli/usage/help_text.h"
#include "log/printed_text.h"
#include "output/output_plan.h"
#include "thimble/scene/arm_file.h"
#include "thimble/session/recording.h"
#include "twin/compare_twin.h"
#include "twin/twin_files.h"
#include "twin/twin_forces.h"
#include "twin/twin_prediction.h"
#include "twin/unseen_constants.h"

namespace thimble::cli {
namespace {

struct TwinCommand {
  std::string recording;
  std::string arm_file;
  std::string output;
  twin::TwinOptions options;
  double min_fit = 0;
};

int compare(const TwinCommand& command) {
  const twin::TwinSpan& span = command.options.span;
  if (!(span.from < span.until)) {
    return report_error(
        {fmt::format("--until {:g}: expected a time after --from {:g}.", span.until, span.from)},
        kExitBadInput);
  }
  output::OutputPlan plan;
  plan.read(command.recording);
  plan.read(command.arm_file);
  plan.write_folder("--output", command.output, {"figures.json"});
  if (auto begun = plan.begin(); !begun) return report_error(begun.error(), kExitBadInput);
  const auto recording = session::read_recording(command.recording);
  if (!recording) return report_error(recording.error(), kExitBadInput);
  const auto file = scene::load_arm(command.arm_file);
  if (!file) return report_error(file.error(), kExitBadInput);
  const auto result = twin::compare_twin(*recording, *file, command.options);
  if (!result) return report_error(result.error(), kExitBadInput);
  scene::print_format("Recording: %s, of the arm %s (%s). Twin: the simulated arm of %s.\n",
                      command.recording.c_str(), recording->info.arm.c_str(),
                      recording->info.device.c_str(), command.arm_file.c_str());
  for (const std::string& sentence : result->comparison.messages)
    scene::print_format("%s\n", sentence.c_str());
  scene::print_format("%s", twin::twin_table(result->comparison).c_str());
  for (const std::string& sentence : twin::never_seen()) {
    scene::print_format("Not tested by motion: %s.\n", sentence.c_str());
  }
  auto figures = twin::twin_figures(result->comparison, command.min_fit);
  scene::print_format("\nForces, RMS over segments of 60 ms:\n%s",
                      twin::force_table(result->forces).c_str());
  for (session::Figure& figure : twin::force_figures(result->forces))
    figures.push_back(std::move(figure));
  if (const auto foretold = twin::twin_prediction(*file)) {
    scene::print_format("\nPredictions of the twin for its arm:\n%s",
                        twin::prediction_text(*foretold).c_str());
    for (session::Figure& figure : twin::prediction_figures(*foretold))
      figures.push_back(std::move(figure));
  } else {
    scene::print_format("\nNo prediction of wall and bounce: %s\n",
                        foretold.error().message.c_str());
  }
  if (!command.output.empty()) {
    const auto written = twin::write_twin(*result, figures, file->name, command.output);
    if (!written) return report_error(written.error(), kExitTrouble);
    scene::print_format("Figures and pictures: %s\n", command.output.c_str());
  }
  const std::string unmet = report::unmet_line(figures);
  if (unmet.empty()) return kExitDone;
  scene::print_toned(scene::Tone::kBad, unmet + "\n");
  return kExitUnmet;
}

}  // namespace

void add_twin_command(CLI::App& app, int& exit_code) {
  CLI::App* sub = app.add_subcommand("twin", "Compare a recorded arm with its simulated twin");
  auto command = std::make_shared<TwinCommand>();
  sub->add_option("FILE", command->recording, "Recording of an arm that moved without a hand")
      ->required();
  add_arm_option(*sub, command->arm_file, "Arm file of the twin")->required();
  sub->add_option("--window", command->options.window, "Length of the compared segments, s")
      ->check(CLI::Range(0.05, 2.0))
      ->capture_default_str();
  sub->add_option("--from", command->options.span.from, "Start of the comparison, s")
      ->check(CLI::NonNegativeNumber);
  sub->add_option("--until", command->options.span.until, "End of the comparison, s")
      ->check(CLI::NonNegativeNumber);
  CLI::Option* min_fit =
      sub->add_option("--min-fit", command->min_fit, "Smallest accepted fit of each axis, %")
          ->check(CLI::Range(0.0, 100.0));
  add_old_name(*sub, "--fit-least", min_fit, command->min_fit)->check(CLI::Range(0.0, 100.0));
  sub->add_option("--output", command->output, "Write figures.json and pictures to this folder")
      ->option_text("DIR");
  add_example(*sub, "thimble twin touch.h5 --arm my_arm.yaml",
              "The recorded forces drive the simulated arm. Its motion is compared with the\n"
              "recorded one.\n"
              "FILE      From `thimble identify --record`, or a part (--from, --until) of a\n"
              "          recording from `thimble run SCENE --record`.\n"
              "--window  The simulated arm begins each segment in the recorded state.\n"
              "--min-fit  A fit of 100 % is the same motion; 0 % is no better than a straight\n"
              "          line. The exit code is 5 if the fit of an axis is smaller.\n"
              "--output  The pictures show motion, error and spectrum.");
  sub->callback([command, &exit_code] { exit_code = compare(*command); });
}

}  // namespace thimble::cli
