#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/render/build_object_touch.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// Largest number of drawn parts of all meshes of a scene with a map, unless they have more
/// triangles themselves. [chosen: parts of 1 mm on an object of 10 cm; 0.1 MB of values]
inline constexpr std::size_t kMapPartsMax = 40'000;
/// A mesh with more triangles is drawn without its map. [chosen: 1.2 MB of values]
inline constexpr std::size_t kMapTrianglesMax = 100'000;

/// One map of a surface, sampled for drawing.
struct MapPicture {
  std::string_view quantity;  ///< "stiffness", "friction factor" or "height".
  std::string_view unit;      ///< "N/m", "" or "mm".
  double min = 0, max = 0;    ///< Range of the map, in `unit`; min <= max.
  std::uint32_t parts = 1;    ///< Parts of each side of a triangle (triangle_grid.h).
  /// Values of all grid points of all triangles, from 0 (`min`) to 1 (`max`).
  std::vector<float> values;
};

/// Returns the map that is drawn: that of the stiffness; without one that of the friction; without
/// both that of the height. The parts are about as fine as the pixels of its picture, and at most
/// `max_parts` unless the mesh has more triangles itself. Empty if
/// there is none, if it cannot be used, or if the mesh has more than kMapTrianglesMax triangles.
/// Precondition: `surface.maps` is of `mesh_W`. Real-time: never from the servo thread.
THIMBLE_EXPORT std::optional<MapPicture> map_picture(const SurfaceChoice& surface,
                                                     const TriangleMesh& mesh_W,
                                                     std::size_t max_parts = kMapPartsMax);

}  // namespace thimble::render
