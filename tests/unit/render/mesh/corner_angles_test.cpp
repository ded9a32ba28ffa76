#include "compact_mesh/corner_angles.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <numbers>

#include "support/random.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

// The approximate angle leaves some roundings undecided: 73 of these triangles would differ without
// the exact arc.
TEST(CornerAngles, AreBitIdenticalToTheExactArc) {
  constexpr int kTriangles = 3'000'000;
  support::Random random(31);
  const auto any = [&random] {
    return Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
  };
  int wrong = 0;
  for (int i = 0; i < kTriangles; ++i) {
    const Vector3d ab = any(), ac = any();
    const double twice_area = ab.cross(ac).norm();
    const double at_a = math::atan2(twice_area, ab.dot(ac));
    const double at_b = math::atan2(twice_area, -ab.dot(ac - ab));
    const std::array<float, 3> exact{static_cast<float>(at_a), static_cast<float>(at_b),
                                     static_cast<float>(std::numbers::pi - at_a - at_b)};
    wrong += corner_angles(ab, ac, twice_area) != exact ? 1 : 0;
  }
  EXPECT_EQ(wrong, 0);
}

}  // namespace
}  // namespace thimble::render
