#pragma once

#include <cstddef>

#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::report {

/// Returns a mesh for display with about `max_triangles` triangles or fewer. If the mesh is
/// larger, all vertices in a cell of a grid are moved to their mean, and degenerate triangles are
/// removed. Not for contact: the result may not be watertight, and differs from the mesh by up to a
/// cell. Real-time: never from the servo thread.
render::TriangleMesh light_mesh(const render::TriangleMesh& mesh, std::size_t max_triangles);

}  // namespace thimble::report
