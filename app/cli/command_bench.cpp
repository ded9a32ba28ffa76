#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include "cli/commands.h"
#include "cli/file_options.h"
#include "cli/report_error.h"
#include "cli/usage/help_text.h"
#include "log/printed_text.h"
#include "output/output_plan.h"
#include "report/figure_output.h"
#include "studies/rate_bench.h"
#include "thimble/scene/shipped_files.h"

namespace thimble::cli {
namespace {

struct BenchOptions {
  std::string scene = "elephant";
  std::vector<double> rates{1000, 4000, 8000};
  double seconds = 4;
  std::string out;
  std::string quality = "normal";
};

int run_bench(const BenchOptions& options) {
  output::OutputPlan plan;
  plan.write_folder("--out", options.out, {"figures.json"}, /*plots=*/false);
  if (auto begun = plan.begin(); !begun) return report_error(begun.error(), kExitBadInput);
  const auto scene = scene::find_scene(options.scene);  // the default was not resolved yet
  if (!scene) return report_error(scene.error(), kExitBadInput);
  const scene::Quality quality =
      scene::quality_named(options.quality).value_or(scene::Quality::kNormal);
  std::vector<session::Figure> figures;
  std::string advice;
  for (const double rate : options.rates) {
    const auto bench = studies::bench_rate(*scene, rate, options.seconds, quality);
    if (!bench) return report_error(bench.error(), kExitBadInput);
    const studies::RateVerdict verdict = studies::verdict_of(*bench);
    scene::print_format("%5.0f Hz  %s\n", rate, verdict.sentence.c_str());
    std::fflush(stdout);
    for (session::Figure& figure : studies::figures_of(*bench, verdict))
      figures.push_back(std::move(figure));
    advice = bench->advice;
  }
  if (!advice.empty()) scene::print_format("%s\n", advice.c_str());
  scene::print_format(
      "These times include the simulated arm. A real arm has its connection instead.\n\n%s",
      report::figure_table(figures).c_str());
  if (options.out.empty()) return kExitDone;
  std::error_code status;
  std::filesystem::create_directories(options.out, status);
  const auto written =
      report::write_figures(figures, std::filesystem::path(options.out) / "figures.json");
  return written ? kExitDone : report_error(written.error(), kExitTrouble);
}

}  // namespace

void add_bench_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("bench", "Measure loop rates on this machine");
  auto options = std::make_shared<BenchOptions>();
  add_scene_option(*command, options->scene)->capture_default_str();
  command->add_option("--rate", options->rates, "Rates to try, Hz")
      ->check(CLI::Range(100, 50'000))
      ->capture_default_str();
  command->add_option("--seconds", options->seconds, "Duration at each rate, s")
      ->check(CLI::Range(0.1, 600.0))
      ->capture_default_str();
  add_quality_option(*command, options->quality, "Accuracy preset, as in `thimble run`");
  command->add_option("--out", options->out, "Write figures.json to this folder")
      ->option_text("DIR");
  add_example(*command, "thimble bench elephant --rate 1000 8000");
  command->callback([options, &exit_code] { exit_code = run_bench(*options); });
}

}  // namespace thimble::cli
