#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// The three neighbours of each triangle: number k is over the edge from corner k to corner k + 1
/// (modulo 3) [BP 3.1, the neighbour array].
using Adjacency = std::vector<std::array<std::int32_t, 3>>;

/// Returns the neighbours of all triangles, as find_adjacency does; none if it fails. Takes two
/// thirds of its instructions on a mesh of many triangles [measured: callgrind], and half of its
/// memory. Real-time: never from the servo thread.
std::optional<Adjacency> adjacency_if_closed(const TriangleMesh& mesh);

/// Finds the neighbours of all triangles. The error names an edge that has no second triangle, has
/// a third one, or is between triangles of opposite winding. Or it names a triangle that does not
/// name three existing vertices. O(n log n). Real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<Adjacency> find_adjacency(const TriangleMesh& mesh);

/// Finds the neighbour of one triangle over the edge from corner `edge` to the next, in the cycle:
/// no memory, one pass over the triangles at worst [BP 3.1, memory against time]. -1 if there is
/// none; of several, the one with the nearest number. Equal to the array's entry wherever
/// find_adjacency has one. Tests nearest numbers first, because most files list neighbours close
/// together. Preconditions: `triangle` exists, `edge` is 0 to 2. Real-time: safe; time grows with
/// the number of triangles.
THIMBLE_EXPORT std::int32_t find_neighbour(const TriangleMesh& mesh, std::int32_t triangle,
                                           std::size_t edge) noexcept;

}  // namespace thimble::render
