#include "thimble/scene/real_arm_terms.h"

#include <fmt/core.h>

#include <algorithm>
#include <system_error>
#include <utility>

#include "arm_policy/feel_check_record.h"
#include "arm_policy/limits_policy.h"
#include "thimble/scene/scene_file.h"
#include "thimble/scene/shipped_files.h"

namespace thimble::scene {
namespace {

namespace fs = std::filesystem;

/// Returns the command that checks this arm, ready to be copied.
std::string check_command(const driver::FoundArm& arm, const RealArmRequest& request) {
  std::string command = "thimble feel-check --device " + arm.name();
  if (!request.arm_file.empty()) command += " --arm " + request.arm_file.string();
  if (!request.firmware.empty()) command += " --firmware " + request.firmware.string();
  if (request.firmware.empty() && arm.kind == driver::ArmKind::kFalcon)
    command += " --firmware FILE";
  return command;
}

}  // namespace

std::string_view name(FeelCheckState state) {
  switch (state) {
    case FeelCheckState::kSimulated:
      return "simulated";
    case FeelCheckState::kPassed:
      return "passed";
    case FeelCheckState::kNone:
      return "none";
    case FeelCheckState::kUnchecked:
      return "unchecked";
  }
  return "none";
}

driver::Result<RealArmTerms> terms_for(const driver::FoundArm& arm, const RealArmRequest& request) {
  auto found = find_real_arm_file(arm, {.arm_file = request.arm_file});
  if (!found) return found.error();
  RealArmTerms terms;
  terms.arm = std::move(found).value();
  terms.told.push_back("Arm file: " + terms.arm.path.string() + " (" + terms.arm.why + ").");
  terms.told.insert(terms.told.end(), terms.arm.told.begin(), terms.arm.told.end());
  if (has_passed(describe_checked(arm, terms.arm, request.firmware))) {
    terms.feel_check = FeelCheckState::kPassed;
    return terms;
  }
  const std::string command = check_command(arm, request);
  if (request.unchecked) {
    terms.feel_check = FeelCheckState::kUnchecked;
    terms.told.push_back(
        fmt::format("UNCHECKED: {} gets up to {:g} N although it has not passed the "
                    "feel check in its present state. To check it: ",
                    arm.name(), terms.arm.file.limits.force_max) +
        command);
    return terms;
  }
  terms.feel_check = FeelCheckState::kNone;
  terms.force_most = kFeelCheckForceMax;
  terms.told.push_back(
      fmt::format("{} has not passed the feel check with this arm file, calibration and firmware, "
                  "so this run gives it at most {:g} N. To check it: ",
                  arm.name(), kFeelCheckForceMax) +
      command);
  return terms;
}

driver::Result<std::vector<std::string>> put_on_terms(Scene& scene, const fs::path& scene_file,
                                                      const RealArmTerms& terms) {
  std::vector<std::string> told;
  scene.arms.front().arm = terms.arm.file;
  scene.arms.front().arm_file = terms.arm.path;
  std::error_code missing;
  const bool same = fs::equivalent(scene.arms.front().own_arm_file, terms.arm.path, missing);
  if (!same && is_installed_arm(scene.arms.front().own_arm_file)) {
    told.push_back(scene_file.string() + ": its arm, " +
                   scene.arms.front().own_arm_file.stem().string() +
                   ", is used for the simulation only; a real arm has its own file.");
  } else if (!same) {
    const auto own = load_arm(scene.arms.front().own_arm_file);
    if (!own) return own.error();
    for (std::string& sentence :
         tighten(scene.arms.front().arm, terms.arm.path, *own, scene.arms.front().own_arm_file)) {
      told.push_back(std::move(sentence));
    }
  }
  if (scene.energy) {
    const auto energy = tighten_energy(scene.arms.front().arm, terms.arm.path, *scene.energy,
                                       scene_file, scene.energy_line);
    if (energy) told.push_back(*energy);
    scene.energy.reset();  // now part of the arm file
  }
  scene.arms.front().arm.limits.force_max =
      std::min(scene.arms.front().arm.limits.force_max, terms.force_most);
  return told;
}

}  // namespace thimble::scene
