#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "bringup/doctor.h"
#include "bringup/doctor_files.h"
#include "cli/commands.h"
#include "cli/exit_code.h"
#include "cli/options/json_option.h"
#include "cli/usage/help_text.h"
#include "files/data_folders.h"
#include "log/logger.h"
#include "log/printed_text.h"

namespace thimble::cli {
namespace {

/// How a finding is shown.
struct Shown {
  const char* mark;  ///< On the terminal.
  const char* word;  ///< In JSON.
  scene::Tone tone;
};

Shown shown(bringup::Health health) {
  switch (health) {
    case bringup::Health::kAdvice:
      return {"advice  ", "advice", scene::Tone::kAdvice};
    case bringup::Health::kProblem:
      return {"PROBLEM ", "problem", scene::Tone::kBad};
    default:
      return {"ok      ", "ok", scene::Tone::kGood};
  }
}

int show_findings(const std::string& root) {
  bringup::SystemInfo system = bringup::this_machine();
  system.root = root;
  int problems = 0;
  std::vector<bringup::Finding> findings = bringup::examine(system);
  findings.push_back(bringup::examine_names(scene::data_folders()));
  findings.push_back(bringup::examine_scans(scene::scan_places()));
  findings.push_back(bringup::examine_log(scene::default_log_file()));
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const bringup::Finding& finding : findings) {
    const Shown as = shown(finding.health);
    if (finding.health == bringup::Health::kProblem) ++problems;
    scene::print_toned(as.tone, as.mark);
    scene::print_format("%s\n", finding.what.c_str());
    if (!finding.remedy.empty()) scene::print_format("          -> %s\n", finding.remedy.c_str());
    list.push_back({{"health", as.word}, {"what", finding.what}, {"remedy", finding.remedy}});
  }
  print_json("doctor", {{"problems", problems}, {"findings", list}});
  if (problems == 0) return kExitDone;
  scene::print_format("%d problem%s.\n", problems, problems == 1 ? "" : "s");
  return kExitNoDevice;
}

}  // namespace

void add_doctor_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("doctor", "Diagnose problems of arms and system, and print the fixes");
  auto root = std::make_shared<std::string>("/");
  command->add_option("--root", *root, "Root folder of the system to examine")
      ->check(CLI::ExistingDirectory)
      ->capture_default_str();
  add_json_option(*command);
  add_example(*command, "thimble doctor");
  command->callback([root, &exit_code] { exit_code = show_findings(*root); });
}

}  // namespace thimble::cli
