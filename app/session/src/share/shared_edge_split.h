#pragma once

#include <array>
#include <cstdint>

#include "thimble/driver/export.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::session {

/// Splits an edge of a mesh at its middle as a run has reported. The two `triangles` at the edge
/// keep the end `kept`. Two new triangles, appended in the same order, have the end `lost`. Returns
/// false and changes nothing if the mesh has no such edge. Real-time: never from the servo thread.
THIMBLE_EXPORT bool split_edge(render::TriangleMesh& mesh, std::uint32_t kept, std::uint32_t lost,
                               std::array<std::uint32_t, 2> triangles);

}  // namespace thimble::session
