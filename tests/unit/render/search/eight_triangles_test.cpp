// Eight triangles at once compared with a segment and a closest point: no relevant one is omitted,
// and few others are kept.
#include "search/eight_triangles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "mesh/closest_point.h"
#include "mesh/segment_crossing.h"
#include "support/random.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;
using Corners = std::array<Vector3d, 3>;
using Eight = std::array<Corners, EightTriangles::kCapacity>;

EightTriangles packed(const Eight& triangles) {
  EightTriangles eight;
  for (std::size_t lane = 0; lane < triangles.size(); ++lane) eight.set(lane, triangles[lane]);
  return eight;
}

/// Eight triangles about as large as a volume, with corners within a third of the allowed distance.
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

/// Query of a segment; counts the kept triangles besides those crossed.
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

TEST(EightTriangles, KeepAllThatASegmentCrosses) {
  support::Random random(1);
  Asked asked;
  for (int i = 0; i < 20000; ++i) {
    const Eight triangles = drawn(random);
    const Vector3d from = random.in_box(1e4);
    asked.ask(triangles, from, from + std::pow(10, random.uniform(3, 6)) * random.direction());
  }
  EXPECT_GT(asked.crossings, 2000);
}

TEST(EightTriangles, KeepAllThatASegmentBarelyTouches) {
  support::Random random(2);
  Asked asked;
  for (int i = 0; i < 20000; ++i) {
    const Eight triangles = drawn(random);
    const Corners& at = triangles[random.bits() % triangles.size()];
    // At a corner, on an edge, or in the plane: where it passes, begins or ends.
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

TEST(EightTriangles, KeepAllWithinTheStatedErrorOfANumber) {
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

TEST(EightTriangles, KeepFewThatAPathDoesNotCross) {
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

TEST(EightTriangles, OverflowOmitsNoCrossedTriangle) {
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

/// Closest point of one of eight triangles, and which of the others are kept.
struct Nearest {
  Vector3d p;
  std::array<double, EightTriangles::kCapacity> squared;
  std::array<bool, EightTriangles::kCapacity> kept;

  Nearest(const Eight& triangles, std::size_t known, const Vector3d& asked, double wrong,
          const Vector3d& seen)
      : p(asked) {
    const auto way_to = [&](std::size_t lane) -> Vector3d {
      const Corners& c = triangles[lane];
      return closest_point(p, c[0], c[1], c[2]) - p;
    };
    const Vector3d to = way_to(known);
    const unsigned near = nearer_of_eight(
        nearest_in_units({.squared = to.squaredNorm(), .to = to, .triangle = 0}, wrong, 1), seen,
        packed(triangles));
    for (std::size_t lane = 0; lane < triangles.size(); ++lane) {
      squared[lane] = way_to(lane).squaredNorm();
      kept[lane] = ((near >> lane) & 1u) != 0;
    }
  }
};

TEST(EightTriangles, KeepEveryTriangleWithinTheBound) {
  support::Random random(6);
  int nearer = 0;
  for (int i = 0; i < 20000; ++i) {
    Eight triangles = drawn(random);
    // Some share a corner, as around a vertex, and are equally near there.
    triangles[1][0] = triangles[0][0];
    triangles[2][1] = triangles[0][0];
    const Vector3d p = std::pow(10, random.uniform(1, 5)) * random.direction();
    const std::size_t known = random.bits() % triangles.size();
    const Nearest nearest(triangles, known, p, 0, p);
    for (std::size_t lane = 0; lane < triangles.size(); ++lane) {
      const bool counts = nearest.squared[lane] <= nearest.squared[known];
      ASSERT_TRUE(nearest.kept[lane] || !counts) << "lane " << lane << ", " << p.transpose();
      nearer += counts && lane != known;
    }
  }
  EXPECT_GT(nearer, 50000);
}

TEST(EightTriangles, KeepFewOthersThanTheNearest) {
  support::Random random(9);
  int kept = 0, farther = 0;
  for (int i = 0; i < 20000; ++i) {
    const Eight triangles = drawn(random);
    const Vector3d p = random.in_box(2e4);
    const Nearest first(triangles, 0, p, 0, p);
    const auto least = std::min_element(first.squared.begin(), first.squared.end());
    const auto known = static_cast<std::size_t>(least - first.squared.begin());
    const Nearest nearest(triangles, known, p, 0, p);
    for (std::size_t lane = 0; lane < triangles.size(); ++lane) {
      if (lane == known) continue;
      kept += nearest.kept[lane];
      ++farther;
    }
  }
  // Those that cross the plane perpendicular to the path at the closest point, but farther to the
  // side.
  EXPECT_LT(kept, 0.5 * farther) << kept << " of " << farther;
}

TEST(EightTriangles, InexactPointKeepsNearTriangles) {
  support::Random random(7);
  constexpr double kWrong = 300;
  int nearer = 0;
  for (int i = 0; i < 20000; ++i) {
    const Eight triangles = drawn(random);
    const Vector3d p = random.in_box(2e4);
    const Nearest nearest(triangles, 0, p, kWrong, p + random.in_box(kWrong));
    for (std::size_t lane = 1; lane < triangles.size(); ++lane) {
      if (nearest.squared[lane] > nearest.squared[0]) continue;
      ASSERT_TRUE(nearest.kept[lane]) << "lane " << lane << ", " << p.transpose();
      ++nearer;
    }
  }
  EXPECT_GT(nearer, 20000);
}

TEST(EightTriangles, OverflowOmitsNoNearTriangle) {
  support::Random random(8);
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  for (const double size : {1e20, 1e30, 1e300, kNaN}) {
    const Eight triangles = drawn(random);
    const Vector3d to = size * Vector3d(0.6, -0.64, 0.48);
    const NearestInUnits nearest =
        nearest_in_units({.squared = to.squaredNorm(), .to = to, .triangle = 0}, 0, 1);
    EXPECT_EQ(nearer_of_eight(nearest, -to, packed(triangles)), 0xffu) << size;
  }
}

}  // namespace
}  // namespace thimble::render
