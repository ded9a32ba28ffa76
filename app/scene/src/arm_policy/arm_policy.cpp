#include "thimble/scene/arm_policy.h"

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
std::string check_command(const driver::FoundArm& arm, const ArmPolicyRequest& request) {
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

driver::Result<ArmPolicy> find_arm_policy(const driver::FoundArm& arm,
                                          const ArmPolicyRequest& request) {
  auto found = find_real_arm_file(arm, {.arm_file = request.arm_file});
  if (!found) return found.error();
  ArmPolicy policy;
  policy.arm = std::move(found).value();
  policy.warnings.push_back("Arm file: " + policy.arm.path.string() + " (" + policy.arm.why + ").");
  policy.warnings.insert(policy.warnings.end(), policy.arm.warnings.begin(),
                         policy.arm.warnings.end());
  if (has_passed(describe_checked(arm, policy.arm, request.firmware))) {
    policy.feel_check = FeelCheckState::kPassed;
    return policy;
  }
  const std::string command = check_command(arm, request);
  if (request.unchecked) {
    policy.feel_check = FeelCheckState::kUnchecked;
    policy.warnings.push_back(
        fmt::format("UNCHECKED: {} gets up to {:g} N although it has not passed the "
                    "feel check in its present state. To check it: ",
                    arm.name(), policy.arm.file.limits.force_max) +
        command);
    return policy;
  }
  policy.feel_check = FeelCheckState::kNone;
  policy.max_force = kFeelCheckForceMax;
  policy.warnings.push_back(
      fmt::format("{} has not passed the feel check with this arm file, calibration and firmware, "
                  "so this run gives it at most {:g} N. To check it: ",
                  arm.name(), kFeelCheckForceMax) +
      command);
  return policy;
}

driver::Result<std::vector<std::string>> apply_arm_policy(Scene& scene, const fs::path& scene_file,
                                                          const ArmPolicy& policy) {
  std::vector<std::string> warnings;
  scene.arms.front().arm = policy.arm.file;
  scene.arms.front().arm_file = policy.arm.path;
  std::error_code missing;
  const bool same = fs::equivalent(scene.arms.front().own_arm_file, policy.arm.path, missing);
  if (!same && is_installed_arm(scene.arms.front().own_arm_file)) {
    warnings.push_back(scene_file.string() + ": its arm, " +
                       scene.arms.front().own_arm_file.stem().string() +
                       ", is used for the simulation only; a real arm has its own file.");
  } else if (!same) {
    const auto own = load_arm(scene.arms.front().own_arm_file);
    if (!own) return own.error();
    for (std::string& sentence :
         tighten(scene.arms.front().arm, policy.arm.path, *own, scene.arms.front().own_arm_file)) {
      warnings.push_back(std::move(sentence));
    }
  }
  if (scene.energy) {
    const auto energy = tighten_energy(scene.arms.front().arm, policy.arm.path, *scene.energy,
                                       scene_file, scene.energy_line);
    if (energy) warnings.push_back(*energy);
    scene.energy.reset();  // now part of the arm file
  }
  scene.arms.front().arm.limits.force_max =
      std::min(scene.arms.front().arm.limits.force_max, policy.max_force);
  return warnings;
}

}  // namespace thimble::scene
