// Eight triangles against a segment at once: none that it crosses is left out, and few others stay.
#include "search/eight_triangles.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "mesh/segment_crossing.h"
#include "support/random.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;
using Corners = std::array<Vector3d, 3>;
using Eight = std::array<Corners, EightTriangles::kMost>;

EightTriangles packed(const Eight& triangles) {
  EightTriangles eight;
  for (std::size_t lane = 0; lane < triangles.size(); ++lane) eight.set(lane, triangles[lane]);
  return eight;
}

/// Eight triangles about as large as a volume, whose corners are a third as far as they may be.
Eight drawn(support::Random& random) {
  constexpr double kSize = 1e4;
  Eight triangles;
  for (Corners& corners : triangles) {
    const Vector3d middle = random.in_box(kSize);
    for (Vector3d& corner : corners) corner = middle + random.in_box(kSize);
  }
  return triangles;
}

bool crossed(const Corners& corners, const Vector3d& from, const Vector3d& to) {
  return crossing(from, to, corners[0], corners[1], corners[2]) != Crossing::kNone;
}

/// Asks about a segment, and counts what is kept beside what is crossed.
struct Asked {
  int kept = 0, crossings = 0, all = 0;

  void ask(const Eight& triangles, const Vector3d& from, const Vector3d& to) {
    const unsigned met = met_of_eight(segment_in_units(to - from, 0, 1), from, packed(triangles));
    for (std::size_t lane = 0; lane < triangles.size(); ++lane) {
      const bool keeps = ((met >> lane) & 1u) != 0;
      const bool crosses = crossed(triangles[lane], from, to);
      ASSERT_TRUE(keeps || !crosses)
          << "lane " << lane << ", " << from.transpose() << " to " << to.transpose();
      kept += keeps && !crosses;
      crossings += crosses;
      ++all;
    }
  }
};

TEST(EightTriangles, LeaveOutNoneThatASegmentCrosses) {
  support::Random random(1);
  Asked asked;
  for (int i = 0; i < 20000; ++i) {
    const Eight triangles = drawn(random);
    const Vector3d from = random.in_box(1e4);
    asked.ask(triangles, from, from + std::pow(10, random.uniform(3, 6)) * random.direction());
  }
  EXPECT_GT(asked.crossings, 2000);
}

TEST(EightTriangles, LeaveOutNoneThatASegmentBarelyTouches) {
  support::Random random(2);
  Asked asked;
  for (int i = 0; i < 20000; ++i) {
    const Eight triangles = drawn(random);
    const Corners& at = triangles[random.bits() % triangles.size()];
    // At a corner, on an edge, or in the plane: where it goes by, begins or ends.
    const double s = random.uniform(0, 1);
    const Vector3d edge = at[0] + s * (at[1] - at[0]);
    const Vector3d inside = edge + random.uniform(0, 1) * (at[2] - edge);
    const Vector3d on = std::array{at[0], edge, inside}[random.bits() % 3];
    const Vector3d way = std::pow(10, random.uniform(-1, 5)) * random.direction();
    const double part = std::array{0.0, 0.5, 1.0}[random.bits() % 3];
    asked.ask(triangles, on - part * way, on + (1 - part) * way);
  }
  EXPECT_GT(asked.crossings, 5000);
}

TEST(EightTriangles, LeaveOutNoneOfANumberThatIsWrongAsFarAsItSays) {
  support::Random random(3);
  constexpr double kWrong = 300;
  int moved_in = 0;
  for (int i = 0; i < 20000; ++i) {
    const Eight triangles = drawn(random);
    const Vector3d from = random.in_box(1e4), to = from + 1e4 * random.direction();
    const Vector3d seen_from = from + random.in_box(kWrong), seen_to = to + random.in_box(kWrong);
    const unsigned met = met_of_eight(segment_in_units(seen_to - seen_from, kWrong, 1), seen_from,
                                      packed(triangles));
    for (std::size_t lane = 0; lane < triangles.size(); ++lane) {
      if (!crossed(triangles[lane], from, to)) continue;
      ASSERT_TRUE((met >> lane) & 1u);
      moved_in += crossed(triangles[lane], seen_from, seen_to) ? 0 : 1;
    }
  }
  EXPECT_GT(moved_in, 100);
}

TEST(EightTriangles, KeepFewThatATicksPathDoesNotCross) {
  support::Random random(4);
  Asked asked;
  for (int i = 0; i < 20000; ++i) {
    const Eight triangles = drawn(random);
    const Vector3d from = random.in_box(1e4);
    asked.ask(triangles, from, from + 2000 * random.direction());
  }
  EXPECT_GT(asked.crossings, 500);
  // Those whose plane or edge it passes within their rounding.
  EXPECT_LT(asked.kept, 0.004 * asked.all);
}

TEST(EightTriangles, LeaveOutNothingByNumbersThatOverflow) {
  support::Random random(5);
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  for (const double size : {1e15, 1e30, 1e300, kNaN}) {
    const Eight triangles = drawn(random);
    for (const Corners& at : triangles) {
      const Vector3d on = (at[0] + at[1] + at[2]) / 3, way = size * Vector3d(0.6, -0.64, 0.48);
      const unsigned met =
          met_of_eight(segment_in_units(way, 0x1p-50 * size, 1), on - 0.5 * way, packed(triangles));
      EXPECT_TRUE((met >> (&at - triangles.data())) & 1u) << size;
    }
  }
}

}  // namespace
}  // namespace thimble::render
