#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// A sign per triangle: +1 if its normal (counter-clockwise corners) points out of the matter, -1
/// if it points in, 0 if undecided [BP 3.1, the OUT array].
using OutArray = std::vector<std::int8_t>;

/// Computes entries of the OUT array one at a time, in the cycle: no memory per triangle, one pass
/// over the mesh per result [BP 3.1, Fig. 3].
///
/// A ray starts above the triangle and ends on a sphere around the mesh. If it crosses an odd
/// number of triangles, the triangle faces into the matter. Rays run along the axis nearest to the
/// normal, not along the normal itself as in the paper. All ways out on that side have the same
/// parity, and along an axis the boxes of nearly all triangles are out of reach. The start is
/// proven, without rounding, to be above the triangle with nothing else between. Crossings at edges
/// and vertices are counted once (see segment_crossing.h), so the result is exact.
class THIMBLE_EXPORT OutFinder {
 public:
  /// Measures the mesh. Keeps a reference: the mesh must outlive the finder and keep its vertices
  /// within the sphere measured now. Real-time: never from the servo thread.
  explicit OutFinder(const TriangleMesh& mesh);

  /// Returns the sign of a triangle. The result is meaningful only if the parts of the mesh are
  /// closed; their winding does not matter. 0 if no start could be proven: a triangle that has no
  /// area, is on another one, or is thinner than the resolution of coordinates. Preconditions:
  /// `triangle` exists, triangles name existing vertices, coordinates are at most 1e15. Real-time:
  /// safe; one pass over the mesh, a dozen at worst.
  std::int8_t find(std::int32_t triangle) const noexcept;

 private:
  const TriangleMesh* mesh_;
  Eigen::Vector3d center_{0, 0, 0};
  double radius_ = 0;  // of a sphere around all vertices
};

/// Computes the whole OUT array, with the results of OutFinder. Triangles that do not name three
/// finite vertices get 0 and are ignored by rays. Triangles are sorted into columns along each
/// axis, so that a ray meets few; about 1 us per triangle. Real-time: never from the servo thread.
THIMBLE_EXPORT OutArray compute_out_array(const TriangleMesh& mesh);

}  // namespace thimble::render
