#pragma once

#include <array>
#include <string_view>

namespace thimble::scene {

/// A key of scene or arm files that has got another name. Files with the old one are still read,
/// with a warning that tells the new one.
struct RenamedKey {
  std::string_view place;  ///< The map it stands in, as YamlMap::set_place names it.
  std::string_view was;    ///< The old name.
  std::string_view is;     ///< The name that the reader asks for.
};

/// All of them. An old name goes away with a major version, not before.
inline constexpr std::array kRenamedKeys{
    RenamedKey{"effects[] texture: sandpaper", "grain", "wavelength"},
    RenamedKey{"objects[].body.motion", "turning", "angular_velocity"},
    RenamedKey{"simulation.gimbal", "swing_degrees", "amplitude_degrees"},
};

}  // namespace thimble::scene
