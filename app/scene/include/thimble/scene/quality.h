#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "thimble/scene/scene_file.h"

namespace thimble::scene {

/// How much of what cannot be felt a run shall spend time on: points on the diagrams of
/// `thimble study accuracy`.
enum class Quality {
  kDraft,      ///< The cheapest that still behaves: for looking whether a scene works at all.
  kNormal,     ///< As the scene says.
  kReference,  ///< Beyond what can be felt, whatever it costs.
};

/// Returns the quality of a name; kNormal if there is none of that name.
Quality quality_named(std::string_view name);

/// Puts a scene on the points of a quality. Returns each choice, and why, in a sentence.
/// `kNormal` changes nothing. What a scene names itself (a blending, a tracker) stays as it is.
/// Real-time: never from the servo thread.
std::vector<std::string> apply_quality(Quality quality, Scene& scene);

}  // namespace thimble::scene
