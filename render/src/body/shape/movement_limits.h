#pragma once

#include <vector>

#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// Finds for each vertex how far it may move (m) so that no triangle can turn over, however the
/// others move within theirs: `share` (0 to 1) of half the least height of the triangles around it.
/// Seen along a triangle's first normal its least width then never falls below (1 - share) of what
/// it was, so it stays on its side. 0 for vertices of triangles without area; infinity for those
/// that no triangle names. Real-time: never from the servo thread.
std::vector<double> movement_limits(const TriangleMesh& mesh, double share = 0.9);

}  // namespace thimble::render
