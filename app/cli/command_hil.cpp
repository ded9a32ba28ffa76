#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "arm_policy/feel_check_record.h"
#include "cli/arm_choice.h"
#include "cli/commands.h"
#include "cli/options/json_option.h"
#include "cli/prompts/yes_question.h"
#include "cli/report_error.h"
#include "cli/usage/help_text.h"
#include "enter_key.h"
#include "hil/hil_files.h"
#include "hil/hil_suite.h"
#include "log/logger.h"
#include "log/printed_text.h"
#include "log/progress.h"
#include "output/output_plan.h"
#include "signals.h"

namespace thimble::cli {
namespace {

struct HilCommand {
  ArmChoice choice;
  hil::HilOptions options;
  std::string suite = "quick";
  std::string json;
  std::string junit;
  bool require_device = false;
  double timeout = 0;  // s; 0: none
};

std::string now_utc() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text;
}

void print(const hil::HilResult& result) {
  const scene::Tone tone = result.outcome == hil::HilOutcome::kPassed   ? scene::Tone::kGood
                           : result.outcome == hil::HilOutcome::kFailed ? scene::Tone::kBad
                                                                        : scene::Tone::kAdvice;
  scene::print_toned(tone, fmt::format("{:<7}", hil::words_of(result.outcome).on_terminal));
  scene::print_format(" %-16s %s\n", result.name.c_str(), result.text.c_str());
  for (const session::Figure& figure : result.figures) {
    if (figure.met()) continue;
    scene::print_format("        %-16s %s = %.4g %s, not %s%s\n", "", figure.name.c_str(),
                        figure.value, figure.unit.c_str(), figure.goal.c_str(),
                        figure.note.empty() ? "" : ("; " + figure.note).c_str());
  }
  std::fflush(stdout);
}

/// Returns the prompt for a person, or for a simulated hand, which follows every request.
bringup::Prompt prompt_of(bool person, const std::atomic<bool>& stop) {
  return [person, &stop](const std::string& what) {
    scene::print_format("%s%s\n", what.c_str(), person ? " Press Enter to begin." : "");
    std::fflush(stdout);
    session::EnterKey key = person ? session::EnterKey::kNothing : session::EnterKey::kPressed;
    while (key == session::EnterKey::kNothing && !stop.load()) {
      key = session::check_enter_key();
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return key == session::EnterKey::kPressed && !stop.load();
  };
}

/// The stop flag of a suite: set by a signal, or when its time is over. Real-time: never from the
/// servo thread.
class SuiteClock {
 public:
  /// `timeout`, s; 0: none.
  SuiteClock(const std::atomic<bool>& interrupted, double timeout)
      : interrupted_(interrupted), timeout_(timeout), thread_([this] { run(); }) {}
  ~SuiteClock() {
    leave_.store(true);
    thread_.join();
  }
  SuiteClock(const SuiteClock&) = delete;
  SuiteClock& operator=(const SuiteClock&) = delete;

  const std::atomic<bool>& stop() const { return stop_; }
  /// Returns whether the suite was stopped by its timeout.
  bool timed_out() const { return timed_out_.load(); }

 private:
  using Clock = std::chrono::steady_clock;

  void run() {
    const Clock::time_point begin = Clock::now();
    while (!leave_.load()) {
      if (interrupted_.load()) stop_.store(true);
      const double passed = std::chrono::duration<double>(Clock::now() - begin).count();
      if (timeout_ > 0 && passed >= timeout_ && !stop_.load()) {
        timed_out_.store(true);
        stop_.store(true);
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  }

  const std::atomic<bool>& interrupted_;
  double timeout_;
  std::atomic<bool> stop_{false}, timed_out_{false}, leave_{false};
  std::thread thread_;
};

/// The result files of a suite. They are written at its start and after each check, so that no
/// older result remains if the program ends early. A pipe or a device gets only the last text,
/// because earlier output cannot be replaced.
class HilFiles {
 public:
  HilFiles(const HilCommand& command, hil::HilRecord record)
      : command_(command), record_(std::move(record)) {}

  hil::HilRecord& record() { return record_; }

  /// Writes the results so far. Each remaining check is marked as not run, with the reason `why`.
  /// `last`: no other text follows.
  driver::Result<void> write(const std::vector<hil::HilResult>& results, const std::string& why,
                             bool last) const {
    const auto all = hil::with_not_run(results, command_.options, why);
    if (is_due(command_.json, last)) {
      if (auto done = hil::write_hil_json(record_, all, command_.json); !done) return done;
    }
    return is_due(command_.junit, last) ? hil::write_hil_junit(record_, all, command_.junit)
                                        : driver::Result<void>();
  }

  /// Writes the files of a suite that ended before any check, and returns its exit code.
  int end_early(const driver::Error& error, ExitCode code) {
    record_.end = code == kExitNoDevice ? "no_arm" : "refused";
    record_.exit_code = code;
    if (auto written = write({}, error.message, true); !written) {
      report_error(written.error(), kExitTrouble);
    }
    return report_error(error, code);
  }

 private:
  static bool is_due(const std::string& file, bool last) {
    if (file.empty() || last) return !file.empty();
    std::error_code none;
    const auto there = std::filesystem::status(file, none);
    return !std::filesystem::exists(there) || std::filesystem::is_regular_file(there);
  }

  const HilCommand& command_;
  hil::HilRecord record_;
};

ExitCode code_of(const std::vector<hil::HilResult>& results) {
  const auto any = [&](auto&& is) { return std::any_of(results.begin(), results.end(), is); };
  if (any([](const hil::HilResult& one) { return one.fault; })) return kExitFault;
  return any([](const hil::HilResult& one) {
    return one.outcome == hil::HilOutcome::kFailed || one.outcome == hil::HilOutcome::kNotRun;
  })
             ? kExitUnmet
             : kExitDone;
}

void print_summary(const std::vector<hil::HilResult>& results) {
  const auto count = [&](hil::HilOutcome outcome) {
    return std::count_if(results.begin(), results.end(),
                         [&](const hil::HilResult& one) { return one.outcome == outcome; });
  };
  const auto not_run = count(hil::HilOutcome::kNotRun);
  const std::string rest = not_run > 0 ? fmt::format(", {} did not run", not_run) : "";
  scene::print_format("%zu check%s: %td passed, %td failed, %td skipped%s.\n", results.size(),
                      results.size() == 1 ? "" : "s", count(hil::HilOutcome::kPassed),
                      count(hil::HilOutcome::kFailed), count(hil::HilOutcome::kSkipped),
                      rest.c_str());
}

int run_hil(HilCommand command) {
  output::OutputPlan plan;
  plan.read(command.choice.arm_file);
  plan.read(command.choice.firmware);
  plan.write("--output", command.json, output::kJson);
  plan.write("--junit", command.junit, output::kXml);
  if (auto begun = plan.begin(); !begun) return report_error(begun.error(), kExitBadInput);
  hil::HilOptions& options = command.options;
  options.full = command.suite == "full";
  HilFiles files(command, {.arm = command.choice.device,
                           .arm_file = command.choice.arm_file,
                           .simulated = command.choice.device == "sim",
                           .suite = command.suite,
                           .time = now_utc()});
  if (auto written = files.write({}, "The suite ended before this check.", false); !written) {
    return report_error(written.error(), kExitTrouble);
  }
  if (command.require_device && command.choice.device == "sim") {
    return files.end_early(
        driver::Error{"--require-device cannot be used with --device sim. Remove "
                      "one of them."},
        kExitNoDevice);
  }
  const auto chosen = resolve(command.choice, false);
  if (!chosen) return files.end_early(chosen.error(), exit_code_of(command.choice));
  if (auto allowed = check_priority(command.choice, *chosen); !allowed) {
    return files.end_early(allowed.error(), kExitBadInput);
  }
  files.record().arm = chosen->name;
  files.record().arm_file = chosen->file.name;
  files.record().simulated = !chosen->real_arm;
  const SimulatedNote simulated(*chosen, "result of a real arm");
  for (const std::string& sentence : chosen->messages)
    scene::print_format("%s\n", sentence.c_str());
  const std::atomic<bool>& interrupted = scene::catch_interrupts();
  if (chosen->real_arm) scene::treat_sigtstp_as_exit();
  const scene::ForceExitGuard guard;
  SuiteClock clock(interrupted, command.timeout);
  const std::atomic<bool>& stop = clock.stop();
  if (chosen->real_arm) {
    const scene::RealArmFile file{
        .path = chosen->path, .file = chosen->file, .why = {}, .warnings = {}};
    options.checked = scene::has_passed(
        scene::describe_checked(*chosen->real_arm, file, command.choice.firmware));
    scene::print_format(
        "The arm will move by itself, with at most %g N. Put the tip into the middle of the "
        "workspace, with nothing within 5 cm of it. Keep the power switch within reach; Ctrl-C "
        "stops the arm.\n",
        hil::kHilForceMax);
  }
  const hil::HilRig rig{
      .file = chosen->file,
      .open =
          [&](hil::TipHold hold) {
            return chosen->real_arm
                       ? bringup::BenchArm::open(chosen->file, chosen->real_arm,
                                                 command.choice.firmware, {}, hil::kHilForceMax)
                       : hil::open_simulated(chosen->file, options, hold);
          },
      .stop = stop,
      .prompt = prompt_of(chosen->real_arm.has_value(), stop),
      .question = chosen->real_arm ? bringup::Question([&stop](const std::string& what) {
        return ask_yes_no(what, stop);
      })
                                   : bringup::Question(),
      .attended = options.attended || !chosen->real_arm};
  if (auto bench = rig.open(hil::TipHold::kFree); !bench) {
    return files.end_early(bench.error(), kExitNoDevice);
  }
  // The cable of a simulated arm cannot be unplugged.
  if (!chosen->real_arm) options.replug = false;
  driver::Result<void> written;
  hil::HilListener listener;
  scene::Progress progress("hil");
  listener.begun = [&](const std::string& name, std::size_t number, std::size_t count) {
    progress.set_share(number - 1, count);
    progress.set_state(name);
    scene::print_format("[%zu/%zu] %s\n", number, count, name.c_str());
    std::fflush(stdout);
  };
  listener.ended = [&](const std::vector<hil::HilResult>& results) {
    print(results.back());
    if (auto done = files.write(results, "The suite ended before this check.", false); !done) {
      written = done;
    }
  };
  const auto results = hil::run_hil_suite(rig, options, listener);
  if (!stop.load()) progress.set_share(1.0);
  for (const hil::HilResult& result : results) {
    if (stop.load() && result.outcome == hil::HilOutcome::kNotRun) print(result);
  }
  ExitCode code = interrupted.load() ? kExitInterrupted : code_of(results);
  files.record().end = interrupted.load()  ? "interrupted"
                       : clock.timed_out() ? "timeout"
                                           : "completed";
  files.record().exit_code = code;
  files.record().not_tested = hil::not_tested(chosen->file, options, results);
  if (auto done = files.write(results, "", true); !done) written = done;
  for (const std::string& sentence : files.record().not_tested) {
    scene::print_format("Not tested: %s\n", sentence.c_str());
  }
  print_summary(results);
  print_json("hil", hil::hil_json(files.record(), results));
  if (clock.timed_out()) {
    scene::print_format("--timeout: the suite was stopped after %g s.\n", command.timeout);
  }
  if (!written) return report_error(written.error(), kExitTrouble);
  scene::logger().info("The suite {} of {} ended with exit code {}.", command.suite, chosen->name,
                       static_cast<int>(code));
  return code;
}

}  // namespace

void add_hil_command(CLI::App& app, int& exit_code) {
  CLI::App* sub =
      app.add_subcommand("hil", "Run the hardware checks of an arm, for a person or a test server");
  auto command = std::make_shared<HilCommand>();
  command->choice.falls_back_to_simulation = false;
  command->choice.add_options(*sub);
  command->choice.add_real_time_option(*sub);
  sub->add_flag("--require-device", command->require_device,
                "Exit with code 3 unless the arm is real")
      ->group("Arm");
  constexpr const char* kChecks = "Checks";
  sub->add_option("--suite", command->suite, "quick: 2 to 3 minutes; full: over an hour")
      ->check(CLI::IsMember({"quick", "full"}))
      ->capture_default_str()
      ->group(kChecks);
  sub->add_option("--check", command->options.only, "Run only this check (repeatable)")
      ->check(CLI::IsMember(hil::hil_checks()))
      ->group(kChecks);
  sub->add_option("--soak", command->options.soak_minutes,
                  "Length of the soak test, min (default 0.5; full 60)")
      ->check(CLI::Range(0.1, 1440.0))
      ->group(kChecks);
  sub->add_option("--timeout", command->timeout, "Stop with zero force after N seconds")
      ->check(CLI::Range(1.0, 1e6))
      ->group(kChecks);
  constexpr const char* kPerson = "With a person at the arm";
  sub->add_flag("--attended", command->options.attended,
                "Also run the feel check, and checks that need a hand")
      ->group(kPerson);
  sub->add_flag("--replug", command->options.replug,
                "Also test an unplugged cable (with --attended)")
      ->group(kPerson);
  sub->add_option("--spring", command->options.spring, "Stiffness of a spring on the tip, N/m")
      ->check(CLI::Range(50.0, 2000.0))
      ->group(kPerson);
  sub->add_option("--known-mass", command->options.known_mass, "Mass to fix to the tip, kg")
      ->check(CLI::Range(0.005, 0.06))
      ->group(kPerson);
  sub->add_option("--known-length", command->options.known_length,
                  "Distance to move the tip along each axis, m")
      ->check(CLI::Range(0.02, 0.2))
      ->group(kPerson);
  constexpr const char* kOutput = "Output";
  sub->add_option("--output", command->json, "Write the results as JSON to a file")
      ->option_text("FILE")
      ->group(kOutput);
  add_json_option(*sub)->group(kOutput);
  sub->add_option("--junit", command->junit, "Write the results as JUnit XML")
      ->option_text("FILE")
      ->group(kOutput);
  add_example(*sub, "thimble hil --suite quick --junit results.xml",
              "--check         A check that applies forces also runs the feel check.\n"
              "--timeout       Remaining checks count as not run (exit code 5).\n"
              "--spring        With --attended: tie the spring to the tip when asked.\n"
              "--known-mass    With --attended: checks the force in newtons, and whether the\n"
              "                base is level. Fix the mass to the tip when asked.\n"
              "--known-length  With --attended: checks encoder counts, ratios and links. Move\n"
              "                the tip from mark to mark when asked.");
  sub->callback([command, &exit_code] { exit_code = run_hil(*command); });
}

}  // namespace thimble::cli
