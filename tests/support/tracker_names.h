#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "thimble/render/contact_choice.h"

namespace thimble::support {

/// All trackers that a scene can name.
inline constexpr auto kTrackers = [] {
  std::array<render::TrackerChoice, render::kTrackerNames.size()> trackers{};
  for (std::size_t i = 0; i < trackers.size(); ++i) {
    trackers[i] = static_cast<render::TrackerChoice>(i);
  }
  return trackers;
}();

/// Returns the name of a tracker in a scene.
inline const char* scene_name(render::TrackerChoice tracker) {
  return render::kTrackerNames[static_cast<std::size_t>(tracker)].data();  // of a literal
}

}  // namespace thimble::support
