#include "run_arm.h"

#include <utility>

#include "thimble/scene/real_arm.h"

namespace thimble::session {

driver::Result<RunArm> choose_run_arm(const std::string& device,
                                      const scene::RealArmRequest& request,
                                      const FindArms& find_arms) {
  RunArm arm;
  if (device == "sim") return arm;
  const auto plugged_in = find_arms();
  const std::vector<driver::FoundArm> none;
  auto chosen = scene::choose_arm(plugged_in ? *plugged_in : none, device);
  if (!chosen) return chosen.error();
  arm.real = std::move(chosen).value();
  if (!arm.real) {
    arm.told.push_back("No arm is plugged in: the simulated one is used.");
    const std::string left = plugged_in ? scene::boards_left_out(*plugged_in) : "";
    if (!left.empty()) arm.told.push_back(left);
    return arm;
  }
  auto terms = scene::terms_for(*arm.real, request);
  if (!terms) return terms.error();
  arm.terms = std::move(terms).value();
  arm.told = arm.terms->told;
  return arm;
}

}  // namespace thimble::session
