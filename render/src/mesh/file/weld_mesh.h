#pragma once

#include "thimble/driver/export.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// Merges all vertices at exactly the same place (0.0 and -0.0 are the same place; a vertex with
/// NaN is not merged). The first one of each place keeps its order; triangles keep theirs. Takes 8
/// to 16 bytes of memory per vertex. Precondition: triangles name existing vertices (load_mesh
/// guarantees it). Real-time: never from the servo thread.
THIMBLE_EXPORT TriangleMesh weld_mesh(TriangleMesh mesh);

}  // namespace thimble::render
