#pragma once

#include <cstddef>
#include <vector>

#include "mesh/repair/orient_mesh.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// What is known of a closed component as a body.
struct ClosedPart {
  double volume = 0;          ///< Six times the signed volume, the mesh's unit cubed.
  std::size_t nested_in = 0;  ///< How many other closed components it lies in.
};

/// Returns what the closed components of a mesh are as bodies; others keep zeros. Reads
/// `component_of`, `count` and `closed` of `found`. A component lies in another if up to eight
/// vertices of it do, each by the parity of what a ray along x crosses. Rays ask trees of boxes:
/// O(n log n), and the triangles that lie over or under such a vertex. Real-time: never from the
/// servo thread.
std::vector<ClosedPart> nest_components(const TriangleMesh& mesh, const MeshComponents& found);

}  // namespace thimble::render
