#pragma once

#include "mesh/adjacency.h"
#include "thimble/driver/export.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// Returns whether a mesh is certainly one sound body: check_mesh finds no fault in it. False is no
/// result: several components, a size far from 1, or a volume that may be rounding are left to
/// check_mesh, which takes three times as long. `neighbours` are the mesh's own. O(n). Real-time:
/// never from the servo thread.
bool certainly_valid(const TriangleMesh& mesh, const Adjacency& neighbours);

/// The same for a mesh whose neighbours are not known. If it returns true, orient_mesh turns
/// nothing, and find_touching_parts finds nothing.
THIMBLE_EXPORT bool certainly_valid(const TriangleMesh& mesh);

}  // namespace thimble::render
