#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "thimble/driver/discovery.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/scene/arm_policy.h"
#include "thimble/scene/real_arm.h"
#include "thimble/session/session.h"

namespace thimble::session {

/// Arm of a run.
struct RunArm {
  std::optional<driver::FoundArm> real;   ///< Real arm; empty: the simulated one is used.
  std::optional<scene::ArmPolicy> terms;  ///< Terms of use of a real arm.
  std::vector<std::string> warnings;      ///< Warnings to show the user, one sentence each.
};

/// Function that lists the connected boards; replaced in tests.
using FindArms = std::function<driver::Result<std::vector<driver::FoundArm>>()>;

/// Chooses the arm of a run. `device` is "sim", for which no boards are listed, "auto", or a name
/// (scene::choose_arm). If boards cannot be listed, there are none. The error says what to do.
/// Real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<RunArm> choose_run_arm(
    const std::string& device, const scene::ArmPolicyRequest& request,
    const FindArms& find_arms = [] { return scene::find_arms(); });

/// Arms of a run, of a scene with one or with several arms.
struct THIMBLE_EXPORT RunArms {
  RunArm one;  ///< Arm of a scene with one arm.
  /// Arms of a scene with several arms; see SessionOptions::real_arms.
  std::map<std::string, std::optional<RealArmUse>> several;
  /// Warnings to show the user, one sentence each.
  std::vector<std::string> warnings;

  /// Returns whether one of the arms is real.
  bool real() const;
};

/// Chooses the arms of a run. `devices` has one word as for `choose_run_arm`, or NAME=WORD for each
/// real arm of a scene. The error says what to do, also if two names select the same arm.
/// Real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<RunArms> choose_run_arms(
    const std::vector<std::string>& devices, const scene::ArmPolicyRequest& request,
    const FindArms& find_arms = [] { return scene::find_arms(); });

}  // namespace thimble::session
