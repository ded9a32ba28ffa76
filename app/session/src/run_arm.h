#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "thimble/driver/discovery.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/scene/real_arm_terms.h"
#include "thimble/session/session.h"

namespace thimble::session {

/// The arm that a run uses.
struct RunArm {
  std::optional<driver::FoundArm> real;      ///< Empty: the simulated one.
  std::optional<scene::RealArmTerms> terms;  ///< On which a real one may be used.
  std::vector<std::string> told;             ///< What the user must know, a sentence each.
};

/// What lists the boards that are plugged in; tests write their own.
using FindArms = std::function<driver::Result<std::vector<driver::FoundArm>>()>;

/// Chooses the arm of a run: `device` is "sim", for which nobody looks, "auto" or a name
/// (scene::choose_arm). Boards that cannot be listed count as none. The error says what to do.
/// Real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<RunArm> choose_run_arm(
    const std::string& device, const scene::RealArmRequest& request,
    const FindArms& find_arms = [] { return driver::find_arms(); });

/// The arms that a run uses, of a scene with one or with several.
struct THIMBLE_EXPORT RunArms {
  RunArm one;                                                ///< Of a scene with one.
  std::map<std::string, std::optional<RealArmUse>> several;  ///< See SessionOptions::real_arms.
  std::vector<std::string> told;  ///< What the user must know, a sentence each.

  /// Returns whether one of them is real.
  bool real() const;
};

/// Chooses the arms of a run. `devices`: one word as `choose_run_arm` takes it, or NAME=WORD for
/// each arm of a scene that shall not be simulated. The error says what to do, also where two names
/// mean one arm. Real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<RunArms> choose_run_arms(
    const std::vector<std::string>& devices, const scene::RealArmRequest& request,
    const FindArms& find_arms = [] { return driver::find_arms(); });

}  // namespace thimble::session
