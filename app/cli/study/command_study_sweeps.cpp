#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>

#include "cli/commands.h"
#include "cli/file_options.h"
#include "cli/options/old_names.h"
#include "cli/report_error.h"
#include "cli/study/end_study.h"
#include "log/printed_text.h"
#include "output/output_plan.h"
#include "signals.h"
#include "studies/fuzz_scenes/study_trouble.h"
#include "studies/stability/study_stability.h"

namespace thimble::cli {
namespace {

/// Options of every study that uses a sweep.
struct SweepChoice {
  std::string out;
  int jobs = 0;
  bool resume = false;

  void add_options(CLI::App& command) {
    CLI::Option* output = command.add_option("--output", out, "Folder for results and journal")
                              ->option_text("DIR")
                              ->capture_default_str();
    add_old_name(command, "--out", output, out);
    command.add_option("--jobs", jobs, "Threads per process; 0: one per core")
        ->check(CLI::Range(0, 1024))
        ->capture_default_str();
    command.add_flag("--resume", resume, "Continue an interrupted run with the same options");
  }
};

/// Runs a study by a sweep, in a single process or as one of the processes that mpirun started. The
/// leading process writes the figures.
template <class Run>
int run_by_sweep(const SweepChoice& choice, const Run& run) {
  const std::atomic<bool>& stop = scene::catch_interrupts();
  const auto team = studies::SweepTeam::join();
  if (!team) return report_error(team.error(), kExitBadInput);
  const bool leads = *team == nullptr || (*team)->rank() == 0;
  output::OutputPlan plan;
  if (leads) plan.write_folder("--output", choice.out, {"figures.json"});
  if (auto begun = plan.begin(); !begun) return report_error(begun.error(), kExitBadInput);
  const auto report = run(
      studies::SweepOptions{
          .folder = choice.out, .jobs = choice.jobs, .resume = choice.resume, .team = team->get()},
      stop);
  if (!report) return report_error(report.error(), kExitBadInput);
  if (report->end == studies::SweepEnd::kHelped) return kExitDone;
  if (report->end == studies::SweepEnd::kStopped) {
    scene::print_format("Interrupted. To continue, run the same command with --resume.\n");
    return kExitInterrupted;
  }
  return end_study(report->figures, choice.out);
}

}  // namespace

void add_stability_options(CLI::App& command, int& exit_code) {
  auto choice = std::make_shared<SweepChoice>();
  auto options = std::make_shared<studies::StabilityOptions>();
  choice->out = "study-stability";
  choice->add_options(command);
  add_arm_option(command, options->arm_file, "Arm file (app/arms)")->required();
  command.add_option("--rate", options->rate, "Rate of the servo loop, Hz")
      ->check(CLI::Range(100, 20'000))
      ->capture_default_str();
  command.add_option("--hand", options->hand, "Hand: arm (from its file), none, or kg, N/m, N s/m")
      ->option_text("MASS,STIFFNESS,DAMPING")
      ->capture_default_str();
  command
      .add_option("--direction", options->direction,
                  "World normal of the wall (default: worst base axis)")
      ->option_text("X Y Z")
      ->expected(3);
  command.add_flag("--coarse", options->coarse, "Use fewer points: seconds instead of a minute");
  command.callback([choice, options, &exit_code] {
    exit_code = run_by_sweep(
        *choice, [&](const studies::SweepOptions& sweep, const std::atomic<bool>& stop) {
          return studies::study_stability(*options, sweep, stop);
        });
  });
}

void add_trouble_options(CLI::App& command, int& exit_code) {
  auto choice = std::make_shared<SweepChoice>();
  auto options = std::make_shared<studies::TroubleOptions>();
  choice->out = "study-trouble";
  choice->add_options(command);
  add_arm_option(command, options->arm_file, "Arm file (app/arms)")->required();
  command.add_option("--count", options->count, "Number of random scenes")
      ->check(CLI::Range(1, 100'000'000))
      ->capture_default_str();
  command.add_option("--seed", options->seed, "Seed of all random numbers")->capture_default_str();
  command.callback([choice, options, &exit_code] {
    exit_code = run_by_sweep(
        *choice, [&](const studies::SweepOptions& sweep, const std::atomic<bool>& stop) {
          return studies::study_trouble(*options, sweep, stop);
        });
  });
}

}  // namespace thimble::cli
