#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "cli/commands.h"
#include "cli/complain.h"
#include "cli/study/end_study.h"
#include "output/output_plan.h"
#include "studies/study.h"

namespace thimble::cli {
namespace {

int run_study(const studies::Study& study, const std::filesystem::path& folder) {
  output::OutputPlan plan;
  plan.write_folder("--out", folder, {"figures.json"});
  if (auto begun = plan.begin(); !begun) return complain(begun.error(), kExitBadInput);
  const auto figures = study.run(folder);
  if (!figures) return complain(figures.error(), kExitTrouble);
  return end_study(*figures, folder);
}

}  // namespace

void add_study_command(CLI::App& app, int& exit_code) {
  CLI::App* group =
      app.add_subcommand("study", "Measure, draw and tell in figures; each study says what");
  group->require_subcommand(1);
  for (const studies::Study& study : studies::studies()) {
    CLI::App* command = group->add_subcommand(std::string(study.name), std::string(study.about));
    auto folder = std::make_shared<std::string>("study-" + std::string(study.name));
    command->add_option("--out", *folder, "Folder for pictures, tables and figures.json")
        ->capture_default_str();
    command->callback([&study, folder, &exit_code] { exit_code = run_study(study, *folder); });
  }
  add_accuracy_study(*group, exit_code);
  add_gating_study(*group, exit_code);
  add_stability_study(*group, exit_code);
  add_trouble_study(*group, exit_code);
}

}  // namespace thimble::cli
