#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "thimble/driver/discovery.h"
#include "thimble/driver/result.h"
#include "thimble/scene/real_arm_terms.h"

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
driver::Result<RunArm> choose_run_arm(
    const std::string& device, const scene::RealArmRequest& request,
    const FindArms& find_arms = [] { return driver::find_arms(); });

}  // namespace thimble::session
