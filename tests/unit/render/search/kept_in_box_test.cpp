#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "search/segment_test.h"
#include "support/random.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

// With divisions only, as defined.
double kept_by_division(double parameter, const Vector3d& way, const Vector3d& a, const Vector3d& b,
                        const Vector3d& c) {
  double begin = 0, end = 1;
  for (int i = 0; i < 3; ++i) {
    if (way[i] == 0) continue;
    const double one = std::min({a[i], b[i], c[i]}) / way[i];
    const double other = std::max({a[i], b[i], c[i]}) / way[i];
    begin = std::max(begin, std::min(one, other));
    end = std::min(end, std::max(one, other));
  }
  return std::max(begin, std::min(parameter, end));
}

TEST(KeptInBox, IsBitIdenticalToDivision) {
  support::Random random(14);
  int kept = 0, moved = 0;
  for (int i = 0; i < 300000; ++i) {
    const Vector3d a = random.in_box(1e6), b = a + random.in_box(1e3), c = a + random.in_box(1e3);
    Vector3d way = random.in_box(2e6);
    if (i % 5 == 0) way[i % 3] = 0;
    double parameter = random.uniform(0, 1);
    // Through a point of the triangle, or at a corner of its box, and the adjacent floating-point
    // numbers.
    if (i % 2 == 0) way = ((a + b + c) / 3) / parameter;
    if (i % 4 == 1 && way[i % 3] != 0) {
      parameter = std::min({a[i % 3], b[i % 3], c[i % 3]}) / way[i % 3];
      if (i % 8 == 1) parameter = std::nextafter(parameter, i % 16 == 1 ? -1.0 : 1.0);
    }
    const double found = kept_in_box(parameter, way, a, b, c);
    ASSERT_EQ(found, kept_by_division(parameter, way, a, b, c)) << i;
    (found == parameter ? kept : moved) += 1;
  }
  EXPECT_GT(kept, 100000);
  EXPECT_GT(moved, 10000);
  // Cases that the division itself decides: the segment along one side of a box of zero width.
  const Vector3d flat(0.1, 0.3, 0.7), side(0.1, 0.3, 0.9), way(1, 3, 8);
  for (double parameter = 0.0999; parameter < 0.1001; parameter += 1e-7) {
    ASSERT_EQ(kept_in_box(parameter, way, flat, side, flat),
              kept_by_division(parameter, way, flat, side, flat));
  }
}

}  // namespace
}  // namespace thimble::render
