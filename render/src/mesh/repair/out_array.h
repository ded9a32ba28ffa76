#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// Holds a sign per triangle: +1 if its normal (counter-clockwise corners) points out of the
/// matter, -1 if it points in, 0 if that cannot be told [BP 3.1, the OUT array].
using OutArray = std::vector<std::int8_t>;

/// Finds entries of the OUT array one at a time, in the cycle: no memory per triangle, one pass
/// over the mesh per answer [BP 3.1, Fig. 3].
///
/// A ray starts above the triangle and ends on a sphere around the mesh; if it crosses an odd
/// number of triangles, the triangle looks into the matter. Rays run along the axis nearest to the
/// normal and not, as the paper's, along the normal itself: every way out on that side is crossed
/// equally often, and along an axis the boxes of nearly all triangles are out of reach. The start
/// is proven, without rounding, to lie above the triangle with nothing else between, and crossings
/// at edges and vertices are counted once (see segment_crossing.h), so the answer is exact.
class THIMBLE_EXPORT OutFinder {
 public:
  /// Measures the mesh. Keeps a reference: the mesh must outlive the finder and keep its vertices
  /// within the sphere found now. Real-time: never from the servo thread.
  explicit OutFinder(const TriangleMesh& mesh);

  /// Finds the sign of a triangle. The answer means something only if the parts of the mesh are
  /// closed; how their triangles are wound does not matter. 0 if no start could be proven: a
  /// triangle that has no area, lies on another one, or is thinner than coordinates can tell.
  /// Preconditions: `triangle` exists, triangles name vertices that exist, coordinates are at most
  /// 1e15. Real-time: safe; one pass over the mesh, a dozen at worst.
  std::int8_t find(std::int32_t triangle) const noexcept;

 private:
  const TriangleMesh* mesh_;
  Eigen::Vector3d center_{0, 0, 0};
  double radius_ = 0;  // of a sphere around all vertices
};

/// Finds the whole OUT array, with the answers of OutFinder. Triangles that name no three finite
/// vertices get 0 and are not seen by rays. Triangles are sorted into columns along each axis, so
/// that a ray meets few; about 1 us per triangle. Real-time: never from the servo thread.
THIMBLE_EXPORT OutArray compute_out_array(const TriangleMesh& mesh);

}  // namespace thimble::render
