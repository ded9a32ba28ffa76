#include <poll.h>
#include <unistd.h>

#include <cstdio>
#include <memory>

#include "arm_choice.h"
#include "calibration.h"
#include "commands.h"
#include "exit_code.h"
#include "feel_check.h"
#include "interrupt.h"

namespace thimble::app {
namespace {

bool enter_pressed() {
  pollfd terminal{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0};
  char ignored[64];
  return poll(&terminal, 1, 0) > 0 && read(STDIN_FILENO, ignored, sizeof ignored) >= 0;
}

int check_arm(const ArmChoice& choice) {
  auto chosen = resolve(choice);
  if (!chosen) {
    std::fprintf(stderr, "thimble: %s\n", chosen.error().message.c_str());
    return kExitNoDevice;
  }
  const auto calibration = load_calibration(chosen->name);
  if (!calibration) {
    std::fprintf(stderr, "thimble: %s\n", calibration.error().message.c_str());
    return kExitBadInput;
  }
  if (*calibration) apply(**calibration, chosen->file);
  auto bench = BenchArm::open(chosen->file, chosen->real_arm, choice.firmware,
                              feel_check_hand({0, 0, 0}), kFeelCheckForceMax);
  if (!bench) {
    std::fprintf(stderr, "thimble: %s\n", bench.error().message.c_str());
    return kExitNoDevice;
  }
  const std::atomic<bool>& stop = catch_interrupts();
  const bool person = !(*bench)->simulated();
  if (person) {
    std::printf("No force above %.1f N. Keep the arm's switch at hand; Ctrl-C ends the check.\n",
                kFeelCheckForceMax);
  }
  const Prompt prompt = [&](const std::string& what) {
    std::printf("%s%s\n", what.c_str(), person ? " Press Enter to begin." : "");
    return !person || (*bench)->hold(enter_pressed, stop);
  };
  bool all = true;
  const auto results = feel_check(**bench, chosen->file, prompt, stop);
  for (const CheckResult& result : results) {
    std::printf("%-7s %-12s %s\n", result.passed ? "ok" : "FAILED", result.name.c_str(),
                result.text.c_str());
    all = all && result.passed;
  }
  if (stop.load()) return kExitInterrupted;
  return all && results.size() == 8 ? kExitDone : kExitFault;
}

}  // namespace

void add_feel_check_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "feel-check", "Check an arm by hand: encoders, directions, forces, watchdog");
  auto choice = std::make_shared<ArmChoice>();
  choice->add_options(*command);
  command->callback([choice, &exit_code] { exit_code = check_arm(*choice); });
}

}  // namespace thimble::app
