#pragma once

#include <cstdint>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// A part of a mesh as a separate mesh.
struct MeshPart {
  TriangleMesh mesh;
  std::vector<std::int32_t> triangles;  ///< Number in the whole mesh of each triangle.
};

/// Divides a closed mesh into parts whose boxes overlap or touch, and one part with all others. A
/// part is a connected component with its cavities. Returns nothing if no boxes overlap: then one
/// surface is the boundary of the material. Windings are those of orient_mesh. Linear in the
/// triangles for a mesh of one component, else O(n log n). Real-time: never from the servo thread.
THIMBLE_EXPORT std::vector<MeshPart> overlapping_parts(const TriangleMesh& mesh);

}  // namespace thimble::render
