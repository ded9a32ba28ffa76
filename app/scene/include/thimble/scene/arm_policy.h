#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "thimble/driver/discovery.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/scene/real_arm_file.h"

namespace thimble::scene {

struct Scene;

/// Largest force during a feel check, and for an arm that has not passed one, N: enough to feel,
/// too little to hurt. [chosen]
inline constexpr double kFeelCheckForceMax = 0.5;

/// State of an arm's feel check at the start of a run.
enum class FeelCheckState : std::uint8_t {
  kSimulated,  ///< The arm is simulated; no check is needed.
  kPassed,     ///< The check was passed, and the arm has not changed since.
  kNone,       ///< No passed check; the force is limited to kFeelCheckForceMax.
  kUnchecked,  ///< No passed check, but the user requested the full force.
};

/// Returns the name of a state in reports ("passed").
THIMBLE_EXPORT std::string_view name(FeelCheckState state);

/// Terms of use of a real arm in a run: its arm file and its force limit.
struct ArmPolicy {
  RealArmFile arm;                                    ///< Arm file of the arm.
  FeelCheckState feel_check = FeelCheckState::kNone;  ///< State of the feel check.
  /// Force limit in addition to that of the arm, N.
  double max_force = std::numeric_limits<double>::infinity();
  /// Warnings to show the user, one sentence each.
  std::vector<std::string> warnings;
};

/// User options for a real arm.
struct ArmPolicyRequest {
  std::filesystem::path arm_file;  ///< Value of --arm; empty: not given.
  std::filesystem::path firmware;  ///< Value of --firmware; empty: not given.
  bool unchecked = false;          ///< Allows the full force without a passed feel check.
};

/// Returns the terms of use of an arm. The error says which command to use. Real-time: never from
/// the servo thread.
THIMBLE_EXPORT driver::Result<ArmPolicy> find_arm_policy(const driver::FoundArm& arm,
                                                         const ArmPolicyRequest& request);

/// Replaces the arm of a scene by the real arm of the terms: arm file, calibration and limits.
/// Limits that the scene sets itself (`gate:`, or an arm file that is not installed) are kept only
/// if they are stricter. Returns one sentence per value kept or ignored. Fails if the scene's own
/// arm file is invalid. Real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<std::vector<std::string>> apply_arm_policy(
    Scene& scene, const std::filesystem::path& scene_file, const ArmPolicy& policy);

/// Former name of ArmPolicy.
using RealArmTerms [[deprecated("renamed to ArmPolicy")]] = ArmPolicy;

/// Former name of ArmPolicyRequest.
using RealArmRequest [[deprecated("renamed to ArmPolicyRequest")]] = ArmPolicyRequest;

/// Former name of `find_arm_policy`. Real-time: never from the servo thread.
[[deprecated("renamed to find_arm_policy")]] inline driver::Result<ArmPolicy> terms_for(
    const driver::FoundArm& arm, const ArmPolicyRequest& request) {
  return find_arm_policy(arm, request);
}

/// Former name of `apply_arm_policy`. Real-time: never from the servo thread.
[[deprecated("renamed to apply_arm_policy")]] inline driver::Result<std::vector<std::string>>
put_on_terms(Scene& scene, const std::filesystem::path& scene_file, const ArmPolicy& policy) {
  return apply_arm_policy(scene, scene_file, policy);
}

}  // namespace thimble::scene
