#pragma once

#include <cstdint>
#include <vector>

#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// Report of split_fans: its vertices and edges, in numbers of the mesh before.
struct SplitFans {
  std::vector<std::int32_t> vertices;      ///< Duplicated vertices, once for each copy.
  std::vector<std::int32_t> parted_edges;  ///< A triangle at each edge that was split.
  std::vector<std::int32_t> turned;        ///< Triangles turned so that sides match.
};

/// Gives every fan of triangles around a vertex its own vertex, copies a rounding apart, and so
/// separates parts that share only a vertex. An edge of four or more triangles is split too if
/// matter and gap alternate around it: the two triangles around each matter keep it. If winding
/// does not distinguish matter from gap, rays do (compute_out_array). New triangles are appended
/// and `origin` (a number per triangle) grows with them. Precondition: triangles name three
/// different finite vertices. Real-time: never from the servo thread.
SplitFans split_fans(TriangleMesh& mesh, std::vector<std::int32_t>& origin);

}  // namespace thimble::render
