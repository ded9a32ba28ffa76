#pragma once

#include "mesh/adjacency.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// Returns whether a mesh is one sound body beyond doubt: check_mesh finds nothing wrong with it.
/// False says nothing: several components, a size far from 1, or a volume that may be rounding are
/// left to check_mesh, which takes three times as long. `neighbours` are the mesh's own. O(n).
/// Real-time: never from the servo thread.
bool surely_sound(const TriangleMesh& mesh, const Adjacency& neighbours);

}  // namespace thimble::render
