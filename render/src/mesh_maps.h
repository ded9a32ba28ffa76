#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>

#include "surface/map/surface_maps.h"
#include "thimble/driver/export.h"
#include "thimble/render/mesh/mesh_file.h"

namespace thimble::render {

/// Returns the maps of a touched mesh that was made from another one by a repair. `source_W` are
/// the vertices of the other mesh at their place in the world (m), `triangles` and `attributes` as
/// in its file. `origins` has the number of the source triangle of each touched one (RepairedMesh),
/// or -1 for none. Real-time: never from the servo thread.
THIMBLE_EXPORT SurfaceMaps surface_maps_of(std::span<const Eigen::Vector3d> source_W,
                                           std::span<const std::array<std::int32_t, 3>> triangles,
                                           const MeshAttributes& attributes,
                                           std::span<const std::int32_t> origins);

}  // namespace thimble::render
