#include "mesh/closest_point.h"

#include <gtest/gtest.h>

#include <random>

#include "support/meshes/reference_geometry.h"
#include "support/seed.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

TEST(ClosestPoint, EqualsThePlainAnswerInAllSevenRegions) {
  std::mt19937_64 random(support::seed_of(2));
  std::normal_distribution<double> normal;
  const auto any = [&] { return Vector3d(normal(random), normal(random), normal(random)); };
  for (int i = 0; i < 100000; ++i) {
    const Vector3d a = any(), b = any(), c = any(), p = 2 * any();
    const double found = (closest_point(p, a, b, c) - p).norm();
    EXPECT_NEAR(found, (support::nearest_on_triangle(p, a, b, c) - p).norm(), 1e-9);
  }
}

TEST(ClosestPoint, NearestCornerIsBitIdentical) {
  const Vector3d a(0.1, 0.2, 0.3), b(1.1, 0.2, 0.3), c(0.1, 1.2, 0.3);
  EXPECT_EQ(closest_point({-1, -1, 2}, a, b, c), a);
  EXPECT_EQ(closest_point({9, 0, -2}, a, b, c), b);
  EXPECT_EQ(closest_point({0, 9, 1}, a, b, c), c);
}

}  // namespace
}  // namespace thimble::render
