#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <memory>
#include <string>
#include <thread>

#include "cli/arm_choice.h"
#include "cli/commands.h"
#include "cli/complain.h"
#include "enter_key.h"
#include "hil/hil_files.h"
#include "hil/hil_suite.h"
#include "interrupt.h"
#include "log/logger.h"
#include "log/printed_text.h"
#include "output/output_plan.h"
#include "terms/feel_check_record.h"

namespace thimble::app {
namespace {

struct HilCommand {
  ArmChoice choice;
  HilOptions options;
  std::string suite = "quick";
  std::string json;
  std::string junit;
};

std::string now_utc() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text;
}

void print(const HilResult& result) {
  const char* const word = result.outcome == HilOutcome::kPassed   ? "ok"
                           : result.outcome == HilOutcome::kFailed ? "FAILED"
                                                                   : "skipped";
  scene::print_format("%-7s %-16s %s\n", word, result.name.c_str(), result.text.c_str());
  for (const Figure& figure : result.figures) {
    if (figure.met()) continue;
    scene::print_format("        %-16s %s = %.4g %s, not %s%s\n", "", figure.name.c_str(),
                        figure.value, figure.unit.c_str(), figure.goal.c_str(),
                        figure.note.empty() ? "" : ("; " + figure.note).c_str());
  }
  std::fflush(stdout);
}

/// Returns the prompt of a person, or of a simulated hand, which does what is asked.
Prompt prompt_of(bool person, const std::atomic<bool>& stop) {
  return [person, &stop](const std::string& what) {
    scene::print_format("%s%s\n", what.c_str(), person ? " Press Enter to begin." : "");
    std::fflush(stdout);
    session::EnterKey key = person ? session::EnterKey::kNothing : session::EnterKey::kPressed;
    while (key == session::EnterKey::kNothing && !stop.load()) {
      key = session::look_for_enter();
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return key == session::EnterKey::kPressed && !stop.load();
  };
}

int end_of(const std::vector<HilResult>& results) {
  int failed = 0, skipped = 0;
  bool fault = false;
  for (const HilResult& result : results) {
    failed += result.outcome == HilOutcome::kFailed ? 1 : 0;
    skipped += result.outcome == HilOutcome::kSkipped ? 1 : 0;
    fault = fault || result.unsafe;
  }
  scene::print_format("%zu checks: %zu passed, %d failed, %d skipped.\n", results.size(),
                      results.size() - static_cast<std::size_t>(failed + skipped), failed, skipped);
  if (fault) return kExitFault;
  return failed > 0 ? kExitUnmet : kExitDone;
}

int run_hil(HilCommand command) {
  output::OutputPlan plan;
  plan.read(command.choice.arm_file);
  plan.read(command.choice.firmware);
  plan.write("--json", command.json, output::kJson);
  plan.write("--junit", command.junit, output::kXml);
  if (auto begun = plan.begin(); !begun) return complain(begun.error(), kExitBadInput);
  const auto chosen = resolve(command.choice, false);
  if (!chosen) return complain(chosen.error(), exit_code_of(command.choice));
  const SimulatedNote simulated(*chosen, "result of a real arm");
  for (const std::string& sentence : chosen->told) scene::print_format("%s\n", sentence.c_str());
  const std::atomic<bool>& stop = scene::catch_interrupts();
  if (chosen->real_arm) scene::leave_rather_than_stop();
  const scene::LeavingGuard guard;
  HilOptions& options = command.options;
  options.full = command.suite == "full";
  if (chosen->real_arm) {
    const scene::RealArmFile file{
        .path = chosen->path, .file = chosen->file, .why = {}, .told = {}};
    options.checked = scene::has_passed(
        scene::describe_checked(*chosen->real_arm, file, command.choice.firmware));
    scene::print_format(
        "The arm will move by itself, with at most %g N. Put its tip into the middle of the "
        "workspace, with nothing within 5 cm of it. Keep its switch at hand; Ctrl-C ends it.\n",
        kHilForceMax);
  }
  const HilRig rig{.file = chosen->file,
                   .open =
                       [&](TipHold hold) {
                         return chosen->real_arm
                                    ? BenchArm::open(chosen->file, chosen->real_arm,
                                                     command.choice.firmware, {}, kHilForceMax)
                                    : open_simulated(chosen->file, options.spring, hold);
                       },
                   .stop = stop,
                   .prompt = prompt_of(chosen->real_arm.has_value(), stop),
                   .told = options.attended || !chosen->real_arm};
  if (auto bench = rig.open(TipHold::kFree); !bench) return complain(bench.error(), kExitNoDevice);
  // Nobody pulls the cable of a simulated arm.
  if (!chosen->real_arm) options.replug = false;
  const HilRecord record{.arm = chosen->name,
                         .arm_file = chosen->file.name,
                         .simulated = !chosen->real_arm,
                         .suite = command.suite,
                         .time = now_utc()};
  const auto results = run_hil_suite(rig, options, print);
  if (!command.json.empty()) {
    if (auto done = write_hil_json(record, results, command.json); !done) {
      return complain(done.error(), kExitTrouble);
    }
  }
  if (!command.junit.empty()) {
    if (auto done = write_hil_junit(record, results, command.junit); !done) {
      return complain(done.error(), kExitTrouble);
    }
  }
  if (stop.load()) return kExitInterrupted;
  const int code = end_of(results);
  scene::logger().info("The suite {} of {} ended with {}.", command.suite, chosen->name, code);
  return code;
}

}  // namespace

void add_hil_command(CLI::App& app, int& exit_code) {
  CLI::App* sub = app.add_subcommand(
      "hil",
      "Check an arm and end with an exit code: reports, delay, watchdog, friction, walls, soak");
  auto command = std::make_shared<HilCommand>();
  command->choice.add_options(*sub);
  sub->add_option("--suite", command->suite, "quick: a minute or two; full: over an hour")
      ->check(CLI::IsMember({"quick", "full"}))
      ->capture_default_str();
  sub->add_flag("--attended", command->options.attended,
                "Somebody is at the arm: also run the feel check, and the checks that need a hand");
  sub->add_flag("--replug", command->options.replug,
                "Also ask for the cable to be pulled (with --attended)");
  sub->add_option("--spring", command->options.spring,
                  "Stiffness of a spring that you tie to the tip when asked, N/m")
      ->check(CLI::Range(50.0, 2000.0));
  sub->add_option("--soak", command->options.soak_minutes,
                  "Length of the soak, minutes; left out: half a minute, or 60 in the full suite")
      ->check(CLI::Range(0.1, 1440.0));
  sub->add_option("--json", command->json, "Write the results to this file as JSON");
  sub->add_option("--junit", command->junit, "Write the results to this file as JUnit XML");
  sub->callback([command, &exit_code] { exit_code = run_hil(*command); });
}

}  // namespace thimble::app
