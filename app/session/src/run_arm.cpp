#include "run_arm.h"

#include <algorithm>
#include <utility>

#include "thimble/scene/real_arm.h"

namespace thimble::session {

driver::Result<RunArm> choose_run_arm(const std::string& device,
                                      const scene::ArmPolicyRequest& request,
                                      const FindArms& find_arms) {
  RunArm arm;
  if (device == "sim") return arm;
  const auto plugged_in = find_arms();
  const std::vector<driver::FoundArm> none;
  auto chosen = scene::choose_arm(plugged_in ? *plugged_in : none, device);
  if (!chosen) return chosen.error();
  arm.real = std::move(chosen).value();
  if (!arm.real) {
    arm.warnings.push_back("No arm is connected: the simulated arm is used.");
    const std::string left = plugged_in ? scene::boards_left_out(*plugged_in) : "";
    if (!left.empty()) arm.warnings.push_back(left);
    return arm;
  }
  auto terms = scene::find_arm_policy(*arm.real, request);
  if (!terms) return terms.error();
  arm.terms = std::move(terms).value();
  arm.warnings = arm.terms->warnings;
  return arm;
}

bool RunArms::real() const {
  return one.real || std::any_of(several.begin(), several.end(),
                                 [](const auto& arm) { return arm.second.has_value(); });
}

driver::Result<RunArms> choose_run_arms(const std::vector<std::string>& devices,
                                        const scene::ArmPolicyRequest& request,
                                        const FindArms& find_arms) {
  RunArms arms;
  if (devices.empty()) return arms;
  if (devices.size() == 1 && devices.front().find('=') == std::string::npos) {
    auto one = choose_run_arm(devices.front(), request, find_arms);
    if (!one) return one.error();
    arms.one = std::move(one).value();
    arms.warnings = arms.one.warnings;
    return arms;
  }
  // Arm of the scene to which each board is assigned.
  std::map<std::string, std::string> taken;
  for (const std::string& device : devices) {
    const std::size_t equals = device.find('=');
    if (equals == std::string::npos || equals == 0) {
      return driver::Error{"--device " + device +
                           ": with several arms, give the scene's name of each: NAME=" + device +
                           "."};
    }
    const std::string name = device.substr(0, equals);
    if (arms.several.contains(name)) {
      return driver::Error{"--device names the arm \"" + name + "\" twice."};
    }
    auto one = choose_run_arm(device.substr(equals + 1), request, find_arms);
    if (!one) return driver::Error{"The arm \"" + name + "\": " + one.error().message};
    for (const std::string& sentence : one->warnings) {
      arms.warnings.push_back("The arm \"" + name + "\": " + sentence);
    }
    if (!one->real) {
      arms.several.emplace(name, std::nullopt);
      continue;
    }
    const auto [other, is_new] = taken.emplace(one->real->name(), name);
    if (!is_new) {
      return driver::Error{"The arms \"" + other->second + "\" and \"" + name +
                           "\" are both assigned to " + one->real->name() +
                           "; choose another device for one of them (see thimble devices)."};
    }
    arms.several.emplace(name, RealArmUse{.arm = *one->real, .terms = *one->terms});
  }
  return arms;
}

}  // namespace thimble::session
