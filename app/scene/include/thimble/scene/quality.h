#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/scene/scene_file.h"

namespace thimble::scene {

/// How much of what cannot be felt a run shall spend time on: points on the diagrams of
/// `thimble study accuracy`.
enum class Quality {
  kDraft,      ///< The cheapest that still behaves: for looking whether a scene works at all.
  kNormal,     ///< As the scene says.
  kReference,  ///< Beyond what can be felt, whatever it costs.
  kAuto,       ///< The cheapest below what can be felt, or the truest within a budget.
};

/// The names of Quality, as a user spells them.
inline constexpr std::array<std::string_view, 4> kQualityNames{"draft", "normal", "reference",
                                                               "auto"};

/// Returns the quality of a name; empty if there is none of that name.
THIMBLE_EXPORT std::optional<Quality> quality_named(std::string_view name);

/// Returns the rate of the loop that a quality asks for, over the scene's own (SceneReading).
THIMBLE_EXPORT double rate_factor_of(Quality quality);

/// Puts a scene on the points of a quality. Returns each choice, and why, in a sentence.
/// `kNormal` changes nothing. What a scene names itself (a blending, a tracker) stays as it is.
/// `budget`: ns per tick for all objects on the machine of the stored diagrams (quality_table.h),
/// of kAuto alone; empty: as cheap as cannot be felt. The loop's rate is chosen when a scene is
/// read. Real-time: never from the servo thread.
THIMBLE_EXPORT std::vector<std::string> apply_quality(Quality quality, Scene& scene,
                                                      std::optional<double> budget = {});

}  // namespace thimble::scene
