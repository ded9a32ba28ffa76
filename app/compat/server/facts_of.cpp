#include "compat/server/facts_of.h"

#include <algorithm>
#include <limits>
#include <string>

#include "compat/server/put_text.h"

namespace thimble::compat {
namespace {

ArmBuild build_of(const scene::ArmFile& arm) {
  if (arm.is<driver::DeltaArm>()) return ArmBuild::kDelta;
  return arm.is<driver::LinkageArm>() ? ArmBuild::kLinkage : ArmBuild::kSerial;
}

}  // namespace

ArmFacts facts_of(const scene::ArmFile& arm, const driver::ArmTraits& traits) {
  ArmFacts facts;
  put_text(facts.name, arm.name);
  put_text(facts.serial, "sim");
  facts.build = build_of(arm);
  facts.has_orientation = traits.has_orientation;
  facts.has_gimbal = traits.has_gimbal;
  facts.has_gripper = traits.has_gripper;
  facts.has_joints = traits.has_joints;
  facts.force_max = arm.limits.force_max;
  facts.force_continuous = arm.declared.continuous_force;
  facts.stiffness_max = arm.declared.stiffness;
  facts.damping_max = arm.declared.damping;
  facts.speed_max = arm.limits.speed_max;
  facts.rise_max = arm.limits.rise_max;
  facts.stall_ns = arm.limits.stall_ns;
  for (std::size_t i = 0; i < 3; ++i) {
    facts.workspace_min[i] = arm.workspace.min_W[static_cast<Eigen::Index>(i)];
    facts.workspace_max[i] = arm.workspace.max_W[static_cast<Eigen::Index>(i)];
  }
  return facts;
}

void number_simulated(ArmFacts& facts, std::size_t index) {
  put_text(facts.serial, "sim" + std::to_string(index + 1));
}

void name_real(ArmFacts& facts, const std::string& name) {
  facts.simulated = false;
  put_text(facts.serial, name);
}

}  // namespace thimble::compat
