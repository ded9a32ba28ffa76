#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/scene/scene_file.h"

namespace thimble::scene {

/// Accuracy/performance presets: points on the diagrams of `thimble study accuracy`.
enum class Quality {
  kDraft,      ///< Lowest cost with stable behaviour, to check that a scene works.
  kNormal,     ///< Settings of the scene.
  kReference,  ///< Accuracy beyond human perception, regardless of cost.
  /// Lowest cost with errors below perception, or the highest accuracy within a budget.
  kAuto,
};

/// Names of the values of Quality in options.
inline constexpr std::array<std::string_view, 4> kQualityNames{"draft", "normal", "reference",
                                                               "auto"};

/// Returns the quality with the given name; empty if there is none.
THIMBLE_EXPORT std::optional<Quality> quality_named(std::string_view name);

/// Returns the factor of a quality on the scene's loop rate (SceneReading::rate_factor).
THIMBLE_EXPORT double rate_factor_of(Quality quality);

/// Applies a quality to a scene. Returns one sentence per choice, with the reason. `kNormal`
/// changes nothing. Values that the scene sets itself (a blending, a tracker other than "auto") are
/// kept. `budget`: time per tick for all objects on the machine of the stored diagrams
/// (quality_table.h), ns; used by kAuto only. If empty, kAuto chooses the lowest cost with errors
/// below perception. The loop rate is chosen when the scene is read. Real-time: never from the
/// servo thread.
THIMBLE_EXPORT std::vector<std::string> apply_quality(Quality quality, Scene& scene,
                                                      std::optional<double> budget = {});

}  // namespace thimble::scene
