#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>

#include "arm_policy/feel_check_record.h"
#include "bringup/feel_check.h"
#include "bringup/listen.h"
#include "cli/arm_choice.h"
#include "cli/commands.h"
#include "cli/prompts/yes_question.h"
#include "cli/report_error.h"
#include "cli/usage/help_text.h"
#include "enter_key.h"
#include "log/logger.h"
#include "log/printed_text.h"
#include "signals.h"

namespace thimble::cli {
namespace {

/// Reads the arm with zero force, and prints statistics of its reports.
int listen_to(bringup::BenchArm& bench, double duration, const std::atomic<bool>& stop) {
  const bringup::ReportStatistics heard = bringup::listen(bench, duration, stop);
  scene::print_format("%s\n", heard.text().c_str());
  if (!heard.whole && !stop.load()) {
    scene::print_format("%s\n", std::string(driver::describe(bench.device().fault())).c_str());
  }
  return heard.good() ? kExitDone : kExitFault;
}

/// Saves that a real arm passed, so that `thimble run` allows its full force. If it failed, removes
/// the result of an earlier check.
driver::Result<void> keep_result(const ChosenArm& chosen, const std::string& firmware,
                                 bool passed) {
  if (!passed) return scene::remove_feel_check(chosen.name);
  const scene::RealArmFile file{
      .path = chosen.path, .file = chosen.file, .why = {}, .warnings = {}};
  auto kept = scene::save_feel_check(scene::describe_checked(*chosen.real_arm, file, firmware));
  if (kept) {
    scene::print_format("Saved in %s: `thimble run` now allows the full force of this arm.\n",
                        scene::feel_check_file(chosen.name).c_str());
  }
  return kept;
}

int check_arm(const ArmChoice& choice, double listen) {
  auto chosen = resolve(choice, false);
  if (!chosen) {
    return report_error(chosen.error(), exit_code_of(choice));
  }
  const SimulatedNote simulated(*chosen, "record of this check");
  for (const std::string& sentence : chosen->messages)
    scene::print_format("%s\n", sentence.c_str());
  // Listening sends zero force only.
  if (auto allowed = check_priority(choice, *chosen); listen == 0 && !allowed) {
    return report_error(allowed.error(), kExitBadInput);
  }
  const std::atomic<bool>& stop = scene::catch_interrupts();
  if (chosen->real_arm) scene::treat_sigtstp_as_exit();
  const scene::ForceExitGuard guard;
  auto bench = bringup::BenchArm::open(
      chosen->file, chosen->real_arm, choice.firmware,
      bringup::feel_check_hand({0, 0, 0}, bringup::feel_check_axes(chosen->file)),
      scene::kFeelCheckForceMax);
  if (!bench) {
    return report_error(bench.error(), kExitNoDevice);
  }
  if (listen > 0) return listen_to(**bench, listen, stop);
  const bool person = !(*bench)->simulated();
  if (person) {
    scene::print_format(
        "The force is at most %.1f N. Keep the power switch within reach; Ctrl-C stops the "
        "check.\n",
        scene::kFeelCheckForceMax);
  }
  const bringup::Prompt prompt = [&](const std::string& what) {
    scene::print_format("%s%s\n", what.c_str(), person ? " Press Enter to begin." : "");
    std::fflush(stdout);
    if (!person) return true;
    session::EnterKey key = session::EnterKey::kNothing;
    const auto done = [&key] {
      return (key = session::check_enter_key()) != session::EnterKey::kNothing;
    };
    return (*bench)->hold(done, stop) && key == session::EnterKey::kPressed;
  };
  // The simulated hand answers from the true force.
  const bringup::Question question = [&](const std::string& what) -> std::optional<bool> {
    if (person) return ask_yes_no(what, stop);
    constexpr double kFelt = 0.1;  // N
    const bool stopped = (*bench)->true_force() < kFelt;
    scene::print_format("%s The simulated hand answers %s.\n", what.c_str(),
                        stopped ? "yes" : "no");
    return stopped;
  };
  bool all = true;
  const auto results = bringup::feel_check(**bench, chosen->file, prompt, stop, question);
  for (const bringup::CheckResult& result : results) {
    scene::print_format("%-7s %-12s %s\n", result.passed ? "ok" : "FAILED", result.name.c_str(),
                        result.text.c_str());
    all = all && result.passed;
  }
  if (stop.load()) return kExitInterrupted;
  const bool passed = all && results.size() == bringup::feel_checks(chosen->file);
  scene::logger().info("The feel check of {} was {}.", chosen->name,
                       passed ? "passed"
                       : all  ? "cancelled"
                              : "failed");
  // A check that was left early changes nothing.
  if (chosen->real_arm && (passed || !all)) {
    if (const auto kept = keep_result(*chosen, choice.firmware, passed); !kept) {
      return report_error(kept.error(), kExitTrouble);
    }
  }
  if (passed) return kExitDone;
  const bool fault =
      std::any_of(results.begin(), results.end(),
                  [](const bringup::CheckResult& result) { return result.name == "fault"; });
  return fault ? kExitFault : kExitUnmet;
}

}  // namespace

void add_feel_check_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "feel-check", "Check encoders, directions, forces and watchdog of an arm by hand");
  auto choice = std::make_shared<ArmChoice>();
  auto listen = std::make_shared<double>(0);
  choice->add_options(*command);
  choice->add_real_time_option(*command);
  command->add_option("--listen", *listen, "Only read the arm for N seconds, with zero force")
      ->check(CLI::Range(0.1, 3600.0));
  add_example(*command, "thimble feel-check --device auto");
  command->callback([choice, listen, &exit_code] { exit_code = check_arm(*choice, *listen); });
}

}  // namespace thimble::cli
