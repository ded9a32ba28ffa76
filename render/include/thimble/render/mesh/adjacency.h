#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "thimble/driver/result.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// Names the three neighbours of each triangle: number k lies over the edge from corner k to corner
/// k + 1 (modulo 3) [BP 3.1, the neighbour array].
using Adjacency = std::vector<std::array<std::int32_t, 3>>;

/// Finds the neighbours of all triangles. The error says which edge has no second triangle, has a
/// third one, or lies between triangles wound against each other, or which triangle does not name
/// three vertices that exist. O(n log n). Real-time: never from the servo thread.
driver::Result<Adjacency> find_adjacency(const TriangleMesh& mesh);

}  // namespace thimble::render
