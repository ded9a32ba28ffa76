#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "compact_mesh/packed_surface.h"
#include "mesh/half_edges.h"

namespace thimble::render {

/// Computes the packed corner normals and the crease bits of unfinished triangles
/// (unfinished_triangle.h) whose corners and neighbours are known. `half_edges` are theirs. Returns
/// -1, or the number of a triangle that has no area. Real-time: never from the servo thread.
std::ptrdiff_t assign_corner_normals(const std::vector<Eigen::Vector3d>& vertices,
                                     const HalfEdges& half_edges, double crease_angle,
                                     std::span<PackedTriangle> packed);

}  // namespace thimble::render
