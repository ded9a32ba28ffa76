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

/// The largest force that a feel check lets through, and that an arm gets which has passed none, N:
/// enough to feel, too little to hurt. [chosen]
inline constexpr double kFeelCheckForceMax = 0.5;

/// What is known of an arm's feel check when a run begins.
enum class FeelCheckState : std::uint8_t {
  kSimulated,  ///< The arm is simulated: there is nothing to check.
  kPassed,     ///< It passed, and is what it was then.
  kNone,       ///< It did not: its force is at most kFeelCheckForceMax.
  kUnchecked,  ///< It did not, and the user wants its whole force all the same.
};

/// Returns how a report names a state ("passed").
THIMBLE_EXPORT std::string_view name(FeelCheckState state);

/// The terms on which a run may use a real arm: which file is the arm's, and how much force it may
/// have.
struct RealArmTerms {
  RealArmFile arm;                                              ///< Which file is the arm's.
  FeelCheckState feel_check = FeelCheckState::kNone;            ///< Whether it passed one.
  double force_most = std::numeric_limits<double>::infinity();  ///< N, beside the arm's own limit.
  std::vector<std::string> told;  ///< What the user must know, a sentence each.
};

/// What a user asked for about a real arm.
struct RealArmRequest {
  std::filesystem::path arm_file;  ///< By --arm; empty: nothing.
  std::filesystem::path firmware;  ///< By --firmware; empty: nothing.
  bool unchecked = false;          ///< Gives the arm its whole force without a passed feel check.
};

/// Returns the terms for an arm. The error says what to type.
/// Real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<RealArmTerms> terms_for(const driver::FoundArm& arm,
                                                      const RealArmRequest& request);

/// Puts the real arm of the terms in place of the scene's: its file, calibration and limits. Of
/// what the scene itself says of limits (`gate:`, or an arm file of its own that is not installed)
/// only what is tighter is kept. Returns a sentence for each value kept or ignored; fails if the
/// scene's own arm file is wrong. Real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<std::vector<std::string>> put_on_terms(
    Scene& scene, const std::filesystem::path& scene_file, const RealArmTerms& terms);

}  // namespace thimble::scene
