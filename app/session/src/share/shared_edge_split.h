#pragma once

#include <array>
#include <cstdint>

#include "thimble/driver/export.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::session {

/// Splits an edge of a mesh in its middle as a run has told of it: the two `triangles` at it keep
/// the end `kept`, and two new ones behind all others, in the same order, have the end `lost`.
/// False if the mesh has no such edge; then nothing has changed. Real-time: never from the servo
/// thread.
THIMBLE_EXPORT bool split_edge(render::TriangleMesh& mesh, std::uint32_t kept, std::uint32_t lost,
                               std::array<std::uint32_t, 2> triangles);

}  // namespace thimble::session
