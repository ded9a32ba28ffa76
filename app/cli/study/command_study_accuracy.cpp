#include <CLI/CLI.hpp>
#include <atomic>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/file_options.h"
#include "cli/options/json_option.h"
#include "cli/options/old_names.h"
#include "cli/report_error.h"
#include "cli/study/end_study.h"
#include "cli/usage/help_text.h"
#include "log/printed_text.h"
#include "output/output_file.h"
#include "output/output_plan.h"
#include "report/figure_json.h"
#include "report/figure_output.h"
#include "signals.h"
#include "studies/accuracy/gating/gating.h"
#include "studies/accuracy/quality_points.h"
#include "studies/accuracy/study_accuracy.h"
#include "studies/run_pages.h"

namespace thimble::cli {
namespace {

struct AccuracyOptions {
  std::vector<std::string> axes;
  std::string out = "study-accuracy";
  std::string table;
  bool no_count = false;
  bool resume = false;
};

int run_accuracy(const AccuracyOptions& options) {
  if (!options.table.empty()) {
    output::OutputPlan plan;
    plan.write("--table", options.table, output::kQualityTable);
    if (auto begun = plan.begin(); !begun) return report_error(begun.error(), kExitBadInput);
    const auto written =
        output::write_file(options.table, output::kQualityTable, studies::quality_table_text());
    if (!written) return report_error(written.error(), kExitTrouble);
    scene::print_format("Points for --quality auto: %s\n", options.table.c_str());
    return kExitDone;
  }
  const std::filesystem::path folder = options.out;
  output::OutputPlan plan;
  plan.write_folder("--output", folder, {"figures.json", "index.html"});
  if (auto begun = plan.begin(); !begun) return report_error(begun.error(), kExitBadInput);
  const std::atomic<bool>& stop = scene::catch_interrupts();
  const auto report = studies::study_accuracy({.axes = options.axes,
                                               .count = !options.no_count,
                                               .resume = options.resume,
                                               .folder = folder},
                                              stop);
  if (!report) return report_error(report.error(), kExitBadInput);
  if (report->stopped) {
    scene::print_format("Interrupted. To continue, run the same command with --resume.\n");
    return kExitInterrupted;
  }
  return end_study(report->figures, folder, "; the page is index.html");
}

struct GatingOptions {
  std::string scene;
  std::string out = "study-gating";
  bool no_count = false;
};

/// Writes pages of the two runs that are compared.
driver::Result<void> write_gating_runs(const std::string& scene,
                                       const studies::GatingReport& report,
                                       const std::filesystem::path& folder) {
  studies::RunPages pages(folder, "Effects of the arm that the scene does not need",
                          "The decisions are in gating.txt; these runs were compared.");
  if (auto added = pages.add(scene, "full", "with all effects of the arm"); !added) return added;
  session::SessionOptions reduced;
  reduced.adjust = [&report](scene::Scene& changed) {
    for (const studies::GateDecision& one : report.decisions) {
      if (one.left_out) studies::leave_out(one.name, changed);
    }
  };
  if (auto added = pages.add(scene, "reduced", "without the unnecessary effects", reduced);
      !added) {
    return added;
  }
  return pages.write();
}

int run_gating(const GatingOptions& options) {
  const std::filesystem::path folder = options.out;
  output::OutputPlan plan;
  plan.read(options.scene);
  plan.write_folder("--output", folder, {"figures.json", "gating.txt", "index.html"});
  if (auto begun = plan.begin(); !begun) return report_error(begun.error(), kExitBadInput);
  const auto report = studies::decide_gating(options.scene, !options.no_count);
  if (!report) return report_error(report.error(), kExitBadInput);
  const std::string text = studies::gating_text(*report);
  scene::print_format("%s", text.c_str());
  for (const auto& written :
       {report::write_figures(studies::figures_of(*report), folder / "figures.json"),
        report::write_text(text, folder / "gating.txt"),
        write_gating_runs(options.scene, *report, folder)}) {
    if (!written) return report_error(written.error(), kExitTrouble);
  }
  print_json("study", {{"folder", folder.string()},
                       {"figures", report::figures_json(studies::figures_of(*report))}});
  scene::print_format("Written to %s; index.html lists the pages of the runs.\n", folder.c_str());
  return kExitDone;
}

}  // namespace

void add_gating_options(CLI::App& command, int& exit_code) {
  auto options = std::make_shared<GatingOptions>();
  add_scene_option(command, options->scene)->required();
  CLI::Option* output =
      command.add_option("--output", options->out, "Folder for gating.txt and figures.json")
          ->option_text("DIR")
          ->capture_default_str();
  add_old_name(command, "--out", output, options->out);
  command.add_flag("--no-count", options->no_count,
                   "Compare times only, without instruction counts");
  command.callback([options, &exit_code] { exit_code = run_gating(*options); });
}

void add_accuracy_options(CLI::App& command, int& exit_code) {
  auto options = std::make_shared<AccuracyOptions>();
  command.add_option("--axis", options->axes, "Parameters to vary, e.g. velocity (default: all)")
      ->option_text("NAME ...");
  CLI::Option* output =
      command.add_option("--output", options->out, "Folder for the page, pictures and tables")
          ->option_text("DIR")
          ->capture_default_str();
  add_old_name(command, "--out", output, options->out);
  command
      .add_option("--table", options->table, "Only write the table of --quality auto (see below)")
      ->option_text("FILE");
  command.add_flag("--no-count", options->no_count,
                   "Compare times only, without instruction counts");
  command.add_flag("--resume", options->resume,
                   "Continue an interrupted run with the same options");
  add_example(command, "thimble study accuracy --axis tessellation velocity",
              "--table measures on this machine the cost and error of the settings from which\n"
              "`thimble run --quality auto` chooses. The file has the format of\n"
              "app/scene/src/quality/quality_table.inc.\n"
              "Without --no-count, the study takes minutes longer.");
  command.callback([options, &exit_code] { exit_code = run_accuracy(*options); });
}

}  // namespace thimble::cli
