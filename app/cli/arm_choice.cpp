#include "cli/arm_choice.h"

#include <cstdio>
#include <optional>
#include <string>
#include <utility>

#include "cli/file_options.h"
#include "log/printed_text.h"
#include "thimble/scene/real_arm.h"
#include "thimble/scene/real_arm_file.h"
#include "thimble/session/servo_thread.h"

namespace thimble::cli {

void ArmChoice::add_options(CLI::App& command) {
  constexpr const char* kArm = "Arm";
  command
      .add_option("--device", device,
                  falls_back_to_simulation
                      ? "auto (plugged-in arm, else simulated), sim, or a name"
                      : "auto (plugged-in arm), sim, or NAME (`thimble devices`)")
      ->option_text("ARM")
      ->capture_default_str()
      ->group(kArm);
  add_arm_option(command, arm_file, "Arm file, if the arm is simulated or reports no model")
      ->group(kArm);
  command.add_option("--firmware", firmware, "Firmware image, for arms that need one")
      ->check(CLI::ExistingFile)
      ->group(kArm);
}

void ArmChoice::add_real_time_option(CLI::App& command) {
  command.add_flag("--no-real-time", no_real_time, "Run a real arm without real-time priority")
      ->group("Arm");
}

driver::Result<void> check_arm_file(const std::string& arm_file) {
  if (arm_file.empty()) return {};
  const auto file = scene::load_arm(arm_file);
  return file ? driver::Result<void>() : file.error();
}

driver::Result<void> check_priority(const ArmChoice& choice, const ChosenArm& chosen) {
  if (!chosen.real_arm) return {};
  return session::check_real_time(session::ServoThread(true).grant(), choice.no_real_time);
}

driver::Result<ChosenArm> resolve(const ArmChoice& choice, bool for_calibration) {
  if (auto readable = check_arm_file(choice.arm_file); !readable) return readable.error();
  ChosenArm chosen;
  std::string left;  // boards of unknown kind
  if (choice.device != "sim") {
    const auto plugged_in = scene::find_arms();
    auto real = scene::choose_arm(plugged_in ? *plugged_in : std::vector<driver::FoundArm>(),
                                  choice.device);
    if (!real) return real.error();
    chosen.real_arm = *real;
    if (plugged_in && !chosen.real_arm) left = scene::boards_left_out(*plugged_in);
  }
  if (!chosen.real_arm) {
    if (choice.device != "sim" && !choice.falls_back_to_simulation) {
      return driver::Error{
          "No known arm is plugged in (see `thimble devices`). Plug it in, or use a simulated arm: "
          "--device sim --arm NAME (see `thimble run --list`)." +
          (left.empty() ? "" : " " + left)};
    }
    if (choice.arm_file.empty() && choice.device == "sim") {
      return driver::Error{
          "--device sim requires an arm file. Add --arm NAME, for example --arm vintage_phantom; "
          "`thimble run --list` lists the arms."};
    }
    if (choice.arm_file.empty()) {
      return driver::Error{
          std::string("No known arm is plugged in (see `thimble devices`). Plug it in, or use a "
                      "simulated arm: --arm NAME (see `thimble run --list`).") +
          (left.empty() ? "" : " " + left)};
    }
    auto file = scene::load_arm(choice.arm_file);
    if (!file) return file.error();
    chosen.file = std::move(file).value();
    chosen.path = choice.arm_file;
    chosen.name = "sim";
    if (!left.empty()) chosen.messages.push_back(left);
    return chosen;
  }
  auto found = scene::find_real_arm_file(
      *chosen.real_arm, {.arm_file = choice.arm_file, .for_calibration = for_calibration});
  if (!found) return found.error();
  chosen.file = std::move(found->file);
  chosen.path = found->path;
  chosen.name = chosen.real_arm->name();
  chosen.messages.push_back("Arm " + chosen.name + ", arm file: " + found->path.string() + " (" +
                            found->why + ").");
  chosen.messages.insert(chosen.messages.end(), found->warnings.begin(), found->warnings.end());
  return chosen;
}

ExitCode exit_code_of(const ArmChoice& refused) {
  const bool bad_input = refused.device == "sim" || !check_arm_file(refused.arm_file);
  return bad_input ? kExitBadInput : kExitNoDevice;
}

SimulatedNote::SimulatedNote(const ChosenArm& arm, const char* kept) {
  if (arm.real_arm) return;
  line_ = "SIMULATED: the arm is a simulated " + arm.file.name + "; no " + kept + " is saved.";
  print();
}

SimulatedNote::~SimulatedNote() {
  if (!line_.empty()) print();
}

void SimulatedNote::print() const {
  std::fflush(stderr);
  scene::print_format("%s\n", line_.c_str());
  std::fflush(stdout);
}

}  // namespace thimble::cli
