#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "mesh/mesh_edges.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

// Steps of repair_mesh for open edges: edges of a single triangle. Precondition of all: triangles
// that name three vertices name finite ones. Real-time: never from the servo thread.

/// Lists the sides of triangles that no other triangle shares.
std::vector<EdgeUse> open_edges(const TriangleMesh& mesh);

/// Merges vertices on open edges within `tolerance` (the mesh's unit, > 0). Each such vertex is
/// replaced by the one with the smallest number near it that stays, so none moves farther than
/// that. Returns the replaced vertices, in ascending order.
std::vector<std::int32_t> weld_open_edges(TriangleMesh& mesh, double tolerance);

/// Closes T-junctions: where a chain of open edges runs along one open edge from end to end within
/// `tolerance`, the triangle of the long edge is split at the chain's vertices. New triangles are
/// appended and `origin` (a number per triangle) grows with them. Returns the split triangles.
std::vector<std::int32_t> close_seams(TriangleMesh& mesh, double tolerance,
                                      std::vector<std::int32_t>& origin);

}  // namespace thimble::render
