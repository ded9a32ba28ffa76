#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// The longest ring of open edges that is closed as a hole; a longer one is a rim.
inline constexpr std::size_t kHoleEdgesMax = 2000;

/// A hole that was closed.
struct FilledHole {
  std::size_t edges = 0;            ///< Number of edges of its rim.
  double width = 0;                 ///< Diagonal of its rim's box, the mesh's unit.
  Eigen::Vector3d middle{0, 0, 0};  ///< Middle of its rim.
};

/// Closes the holes of parts (triangles connected over edges), each part wholly or not at all. A
/// part is closed if all of its rims are rings of at most `kHoleEdgesMax` edges and no edge has
/// more than two triangles. Also, the filling must have no more than `share` of the part's area. So
/// a box without lid is closed. A sheet, whose rim would be closed by a second sheet, is not. New
/// triangles are appended, wound like their neighbours, and `origin` (a number per triangle) grows
/// with them. Returns the holes closed. Preconditions: triangles name three different finite
/// vertices; no vertex joins parts that share nothing else. Real-time: never from the servo thread.
std::vector<FilledHole> fill_holes(TriangleMesh& mesh, double share,
                                   std::vector<std::int32_t>& origin);

}  // namespace thimble::render
