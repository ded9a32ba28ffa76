#pragma once

#include <cstddef>
#include <vector>

#include "mesh/repair/orient_mesh.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// Properties of a closed component as a body.
struct ClosedPart {
  double volume = 0;          ///< Six times the signed volume, the mesh's unit cubed.
  std::size_t nested_in = 0;  ///< Number of other closed components around it.
};

/// Returns the properties of the closed components of a mesh; others keep zeros. Reads
/// `component_of`, `count` and `closed` of `found`. A component is inside another if up to eight
/// vertices of it are, each by the parity of crossings of a ray along x. Rays use trees of boxes:
/// O(n log n), plus the triangles over or under such a vertex. Real-time: never from the servo
/// thread.
std::vector<ClosedPart> nest_components(const TriangleMesh& mesh, const MeshComponents& found);

}  // namespace thimble::render
