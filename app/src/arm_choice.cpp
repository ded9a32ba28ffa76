#include "arm_choice.h"

#include <optional>
#include <utility>

#include "file_options.h"
#include "real_arm.h"

namespace thimble::app {

void ArmChoice::add_options(CLI::App& command) {
  command.add_option("--device", device, "Arm: sim, auto, or a name that `thimble devices` lists")
      ->capture_default_str();
  add_arm_option(command, arm_file, "Its arm file (app/arms)")->required();
  command.add_option("--firmware", firmware, "Firmware image for an arm that needs one")
      ->check(CLI::ExistingFile);
}

driver::Result<ChosenArm> resolve(const ArmChoice& choice) {
  ChosenArm chosen;
  chosen.name = "sim";
  auto file = read_arm_file(choice.arm_file);
  if (!file) return file.error();
  chosen.file = std::move(file).value();
  if (choice.device == "sim") return chosen;
  const auto plugged_in = driver::find_arms();
  auto real = choose_arm(plugged_in ? *plugged_in : std::vector<driver::FoundArm>(), choice.device);
  if (!real) return real.error();
  chosen.real_arm = *real;
  if (chosen.real_arm) {
    if (auto fits = check_fits(chosen.file, *chosen.real_arm); !fits) return fits.error();
    chosen.name = chosen.real_arm->name();
  }
  return chosen;
}

}  // namespace thimble::app
