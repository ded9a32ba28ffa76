#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include "cli/commands.h"
#include "cli/file_options.h"
#include "cli/options/json_option.h"
#include "cli/options/old_names.h"
#include "cli/report_error.h"
#include "cli/usage/help_text.h"
#include "log/printed_text.h"
#include "log/progress.h"
#include "output/output_plan.h"
#include "report/figure_json.h"
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
  plan.write_folder("--output", options.out, {"figures.json"}, /*plots=*/false);
  if (auto begun = plan.begin(); !begun) return report_error(begun.error(), kExitBadInput);
  const auto scene = scene::find_scene(options.scene);  // the default was not resolved yet
  if (!scene) return report_error(scene.error(), kExitBadInput);
  const scene::Quality quality =
      scene::quality_named(options.quality).value_or(scene::Quality::kNormal);
  std::vector<session::Figure> figures;
  std::string advice;
  nlohmann::ordered_json rates = nlohmann::ordered_json::array();
  scene::Progress progress("bench");
  const double duration = options.seconds * static_cast<double>(options.rates.size());
  double begun_at = 0;
  for (const double rate : options.rates) {
    const auto bench = studies::bench_rate(
        *scene, rate, options.seconds, quality, [&progress, &begun_at, duration](double passed) {
          progress.set_share(std::min((begun_at + passed) / duration, 1.0));
        });
    begun_at += options.seconds;
    if (!bench) return report_error(bench.error(), kExitBadInput);
    const studies::RateVerdict verdict = studies::verdict_of(*bench);
    scene::print_format("%5.0f Hz  %s\n", rate, verdict.sentence.c_str());
    std::fflush(scene::text_stream());
    rates.push_back({{"rate_Hz", rate}, {"verdict", verdict.sentence}});
    for (session::Figure& figure : studies::figures_of(*bench, verdict))
      figures.push_back(std::move(figure));
    advice = bench->advice;
  }
  progress.set_share(1.0);
  if (!advice.empty()) scene::print_format("%s\n", advice.c_str());
  scene::print_format(
      "These times include the simulated arm. A real arm has its connection instead.\n\n%s",
      report::figure_table(figures).c_str());
  print_json("bench", {{"scene", options.scene},
                       {"rates", rates},
                       {"advice", advice},
                       {"figures", report::figures_json(figures)}});
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
  CLI::Option* duration =
      command->add_option("--duration", options->seconds, "Duration at each rate, s")
          ->check(CLI::Range(0.1, 600.0))
          ->capture_default_str();
  add_old_name(*command, "--seconds", duration, options->seconds)->check(CLI::Range(0.1, 600.0));
  add_quality_option(*command, options->quality, "Accuracy preset, as in `thimble run`");
  CLI::Option* output =
      command->add_option("--output", options->out, "Write figures.json to this folder")
          ->option_text("DIR");
  add_old_name(*command, "--out", output, options->out);
  add_json_option(*command);
  add_example(*command, "thimble bench elephant --rate 1000 8000");
  command->callback([options, &exit_code] { exit_code = run_bench(*options); });
}

}  // namespace thimble::cli
