#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesh/mesh_edges.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// Returns the sides of one edge in the order of their triangles around it, counter-clockwise as
/// seen from its vertex `high`. A triangle that has the edge upwards has its outer side towards the
/// next one, the other its inner side. Triangles on top of each other (within 1e-6 rad) have the
/// order of their sources, the same in space for every piece of an edge that was cut. `sources`
/// holds the source triangle of each; if empty, its own number. Precondition: `uses` share one
/// edge. Real-time: never from the servo thread.
std::vector<EdgeUse> around_edge(const TriangleMesh& mesh, std::span<const EdgeUse> uses,
                                 std::span<const std::int32_t> sources = {});

}  // namespace thimble::render
