#pragma once

#include <cstdint>
#include <vector>

#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// What split_fans did, by the vertices and edges that it found, in numbers of the mesh before.
struct SplitFans {
  std::vector<std::int32_t> vertices;      ///< Doubled, once for each time.
  std::vector<std::int32_t> parted_edges;  ///< A triangle at each edge that was parted.
  std::vector<std::int32_t> turned;        ///< Triangles turned round so that sides match.
};

/// Returns every fan of triangles around a vertex a vertex of its own, copies a rounding apart, and
/// so parts what shares only a vertex. An edge of four and more triangles that lie around it by
/// turns, matter, gap, matter, gap, is parted too: the two triangles around each matter keep it.
/// Where winding does not tell matter from gap, rays do (compute_out_array). New triangles are
/// appended and `origin` (a number per triangle) grows with them. Precondition: triangles name
/// three different finite vertices. Real-time: never from the servo thread.
SplitFans split_fans(TriangleMesh& mesh, std::vector<std::int32_t>& origin);

}  // namespace thimble::render
