#pragma once

#include <cstddef>

#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::report {

/// Returns a mesh to look at, of about `triangles_most` triangles or fewer: the mesh itself if it
/// is no larger; else with all vertices in a cell of a grid moved to their mean and the triangles
/// left out that this makes flat. Not to be touched: it may not be closed, and differs from the
/// mesh by up to a cell. Real-time: never from the servo thread.
render::TriangleMesh light_mesh(const render::TriangleMesh& mesh, std::size_t triangles_most);

}  // namespace thimble::report
