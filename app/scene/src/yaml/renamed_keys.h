#pragma once

#include <array>
#include <string_view>

namespace thimble::scene {

/// Renamed key of scene or arm files. Files with the old name are accepted with a warning that
/// gives the new one.
struct RenamedKey {
  std::string_view place;  ///< Map that contains the key, as named by YamlMap::set_place.
  std::string_view was;    ///< Old name.
  std::string_view is;     ///< New name, requested by the reader.
};

/// All renamed keys. The guide's page of the API lists them, and says when old names may be
/// removed.
inline constexpr std::array kRenamedKeys{
    RenamedKey{"effects[] texture: sandpaper", "grain", "wavelength"},
    RenamedKey{"objects[].body.motion", "turning", "angular_velocity"},
    RenamedKey{"simulation.gimbal", "swing_degrees", "amplitude_degrees"},
};

}  // namespace thimble::scene
