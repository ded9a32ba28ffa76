#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

#include "search/segment_test.h"
#include "support/meshes/shapes.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

// The box of such a segment does not fit into 32 bits on the side where it begins, so it is cut to
// the largest or smallest integer in use.
TEST(SegmentSieve, KeepsCrossedTrianglesOfVeryLongSegments) {
  const PackedSurface surface = PackedSurface::build(support::icosphere(1, 1)).value();
  std::vector<std::int32_t> all(static_cast<std::size_t>(surface.triangle_count()));
  std::iota(all.begin(), all.end(), 0);
  for (int axis = 0; axis < 3; ++axis) {
    for (const double distance : {3.0, -3.0, 1e14, -1e14}) {
      const Vector3d to(0.01, 0.02, 0.03);
      Vector3d from = to;
      from[axis] += distance;
      const SegmentTest segment(surface, from, to);
      std::vector<std::int32_t> near(all.size());
      near.resize(SegmentSieve(segment).select_near(all, near.data()));
      int entries = 0;
      for (const std::int32_t t : all) {
        double parameter = 0;
        if (segment.cross(t, parameter) != Crossing::kEnters) continue;
        ++entries;
        EXPECT_EQ(std::count(near.begin(), near.end(), t), 1) << axis << ", " << distance;
      }
      EXPECT_EQ(entries, 1) << axis << ", " << distance;
    }
  }
}

}  // namespace
}  // namespace thimble::render
