#include <CLI/CLI.hpp>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "cli/commands.h"
#include "cli/options/json_option.h"
#include "cli/options/old_names.h"
#include "cli/report_error.h"
#include "cli/study/end_study.h"
#include "cli/usage/help_text.h"
#include "output/output_plan.h"
#include "studies/study.h"

namespace thimble::cli {
namespace {

int run_study(const studies::Study& study, const std::filesystem::path& folder) {
  output::OutputPlan plan;
  plan.write_folder("--output", folder, {"figures.json"});
  if (auto begun = plan.begin(); !begun) return report_error(begun.error(), kExitBadInput);
  const auto figures = study.run(folder);
  if (!figures) return report_error(figures.error(), kExitTrouble);
  return end_study(*figures, folder);
}

using AddOptions = void (*)(CLI::App& command, int& exit_code);

/// Returns the function that adds a study's options and runs it. Throws std::out_of_range for a
/// study without one: an error in this table, which shows in every run of the command.
AddOptions options_of(const studies::Study& study) {
  static const std::map<std::string_view, AddOptions> table{{"accuracy", add_accuracy_options},
                                                            {"gating", add_gating_options},
                                                            {"stability", add_stability_options},
                                                            {"trouble", add_trouble_options}};
  return table.at(study.name);
}

}  // namespace

void add_study_command(CLI::App& app, int& exit_code) {
  CLI::App* group = app.add_subcommand("study", "Run a study; write plots and figures");
  group->require_subcommand(1);
  for (const studies::Study& study : studies::studies()) {
    CLI::App* command = group->add_subcommand(std::string(study.name), std::string(study.about));
    add_json_option(*command);
    if (!study.run) {
      options_of(study)(*command, exit_code);
      continue;
    }
    auto folder = std::make_shared<std::string>("study-" + std::string(study.name));
    CLI::Option* output = command->add_option("--output", *folder, "Folder for the results")
                              ->option_text("DIR")
                              ->capture_default_str();
    add_old_name(*command, "--out", output, *folder);
    command->callback([&study, folder, &exit_code] { exit_code = run_study(study, *folder); });
  }
  add_example(*group, "thimble study friction --output friction",
              "A study writes pictures, tables and figures.json (measured values). The exit\n"
              "code is 5 if a value misses its goal.");
}

}  // namespace thimble::cli
