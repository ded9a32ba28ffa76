#pragma once

#include <array>

#include "thimble/render/build_object_touch.h"

namespace thimble::support {

/// All trackers that a scene can name.
inline constexpr std::array kTrackers{
    render::TrackerChoice::kEdgePlanes, render::TrackerChoice::kNormalProjection,
    render::TrackerChoice::kOffset, render::TrackerChoice::kGodObject,
    render::TrackerChoice::kPacked};

/// Returns the name of a tracker in a scene.
inline const char* scene_name(render::TrackerChoice tracker) {
  switch (tracker) {
    case render::TrackerChoice::kEdgePlanes:
      return "edge_planes";
    case render::TrackerChoice::kNormalProjection:
      return "normal_projection";
    case render::TrackerChoice::kOffset:
      return "offset";
    case render::TrackerChoice::kGodObject:
      return "god_object";
    case render::TrackerChoice::kPacked:
      break;
  }
  return "compact";
}

}  // namespace thimble::support
