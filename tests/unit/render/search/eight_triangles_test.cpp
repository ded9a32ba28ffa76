// Eight triangles at once compared with a segment and a closest point: no relevant one is omitted,
// and few others are kept.
#include "search/eight_triangles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
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

/// Distances of eight triangles from a point, exact and as measured.
struct Measured {
  std::array<double, EightTriangles::kCapacity> exact{};
  alignas(32) std::array<float, EightTriangles::kCapacity> low{};
  NearestInUnits nearest;
  unsigned kept = 0;

  /// `seen` is `p` with an error of at most `wrong` along each axis.
  Measured(const Eight& triangles, const Vector3d& p, double wrong, const Vector3d& seen,
           unsigned there = 0xff)
      : nearest(nearest_in_units(kAnywhere, wrong, 1)) {
    for (std::size_t lane = 0; lane < triangles.size(); ++lane) {
      const Corners& c = triangles[lane];
      exact[lane] = (closest_point(p, c[0], c[1], c[2]) - p).norm();
    }
    kept = measure_eight(nearest, seen, packed(triangles), there, low.data());
  }

  bool keeps(std::size_t lane) const { return ((kept >> lane) & 1u) != 0; }
  double least() const { return *std::min_element(exact.begin(), exact.end()); }

  /// Expects that all bounds are right.
  void expect_right() const {
    ASSERT_GE(static_cast<double>(nearest.far), least());
    for (std::size_t lane = 0; lane < exact.size(); ++lane) {
      ASSERT_LE(static_cast<double>(low[lane]), exact[lane]) << "lane " << lane;
      ASSERT_TRUE(keeps(lane) || exact[lane] > least()) << "lane " << lane;
    }
  }

  static constexpr double kAnywhere = 1e6;
};

/// Changes some of eight triangles: narrow ones, points, shared corners and right angles.
void degrade(Eight& triangles, support::Random& random) {
  for (Corners& c : triangles) {
    switch (random.bits() % 6) {
      case 0:
        c[2] = c[0] + random.uniform(-0.5, 1.5) * (c[1] - c[0]) +
               std::pow(10, random.uniform(-2, 3)) * random.direction();
        break;
      case 1:
        c[1] = c[0] + std::pow(10, random.uniform(-1, 2)) * random.direction();
        break;
      case 2:
        c[1] = c[2] = c[0];
        break;
      case 3:
        c[0] = triangles[0][0];
        break;
      default:
        break;
    }
  }
}

/// A point far away, near, or on a corner, an edge or the inside of one of eight triangles.
Vector3d drawn_point(const Eight& triangles, support::Random& random) {
  const Corners& at = triangles[random.bits() % triangles.size()];
  const double s = random.uniform(0, 1), t = random.uniform(0, 1 - s);
  const std::array<Vector3d, 4> on{at[0], at[0] + s * (at[1] - at[0]),
                                   at[0] + s * (at[1] - at[0]) + t * (at[2] - at[0]),
                                   random.in_box(2e4)};
  return on[random.bits() % on.size()] + std::pow(10, random.uniform(-2, 4.5)) * random.direction();
}

TEST(EightTriangles, MeasuredDistancesAreRightBounds) {
  support::Random random(6);
  for (int i = 0; i < 100000; ++i) {
    Eight triangles = drawn(random);
    if (i % 2 == 0) degrade(triangles, random);
    const Vector3d p = drawn_point(triangles, random);
    Measured(triangles, p, 0, p).expect_right();
    if (HasFatalFailure()) FAIL() << "draw " << i;
  }
}

TEST(EightTriangles, MeasuredDistancesAreRightForAnInexactPoint) {
  support::Random random(7);
  constexpr double kWrong = 300;
  for (int i = 0; i < 30000; ++i) {
    Eight triangles = drawn(random);
    if (i % 2 == 0) degrade(triangles, random);
    const Vector3d p = drawn_point(triangles, random);
    Measured(triangles, p, kWrong, p + random.in_box(kWrong)).expect_right();
    if (HasFatalFailure()) FAIL() << "draw " << i;
  }
}

TEST(EightTriangles, MeasuredDistancesAreClose) {
  support::Random random(9);
  int kept = 0, all = 0;
  for (int i = 0; i < 20000; ++i) {
    const Eight triangles = drawn(random);
    const Vector3d p = random.in_box(2e4);
    const Measured measured(triangles, p, 0, p);
    kept += std::popcount(measured.kept);
    ++all;
    // Rounded corners and the stated margin: 20 of 32,700 units.
    ASSERT_LT(static_cast<double>(measured.nearest.far), measured.least() + 20);
  }
  EXPECT_LT(kept, 1.02 * all);
}

TEST(EightTriangles, LanesWithoutATriangleAreNotMeasured) {
  support::Random random(10);
  for (int i = 0; i < 1000; ++i) {
    Eight triangles = drawn(random);
    const Vector3d p = random.in_box(1e4);
    // The nearest one is not there.
    for (Vector3d& corner : triangles[3]) corner = p;
    const Measured measured(triangles, p, 0, p, 0xf7);
    EXPECT_FALSE(measured.keeps(3));
    double least = Measured::kAnywhere;
    for (std::size_t lane = 0; lane < triangles.size(); ++lane) {
      if (lane != 3) least = std::min(least, measured.exact[lane]);
    }
    ASSERT_GE(static_cast<double>(measured.nearest.far), least);
  }
}

TEST(EightTriangles, KeepEveryTriangleThatMayBeNearer) {
  support::Random random(8);
  int nearer = 0, farther = 0, kept_farther = 0;
  for (int i = 0; i < 20000; ++i) {
    const Eight first = drawn(random), others = drawn(random);
    const Vector3d p = drawn_point(first, random);
    const Measured known(first, p, 0, p), there(others, p, 0, p);
    const unsigned near = nearer_of_eight(known.nearest, p, packed(others));
    for (std::size_t lane = 0; lane < others.size(); ++lane) {
      const bool keeps = ((near >> lane) & 1u) != 0;
      const bool counts = there.exact[lane] <= known.least();
      ASSERT_TRUE(keeps || !counts) << "draw " << i << ", lane " << lane;
      nearer += counts;
      farther += !counts;
      kept_farther += keeps && !counts;
    }
  }
  EXPECT_GT(nearer, 5000);
  // Those that cross the plane perpendicular to the path, but farther to the side.
  EXPECT_LT(kept_farther, 0.6 * farther);
}

TEST(EightTriangles, OverflowOmitsNoNearTriangle) {
  support::Random random(8);
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  for (const double size : {1e10, 1e20, 1e30, kNaN}) {
    const Eight triangles = drawn(random);
    const Vector3d p = size * Vector3d(0.6, -0.64, 0.48);
    alignas(32) std::array<float, EightTriangles::kCapacity> low{};
    NearestInUnits nearest = nearest_in_units(2 * size, 0, 1);
    EXPECT_NE(measure_eight(nearest, p, packed(triangles), 0xff, low.data()), 0u) << size;
    for (const float v : low) EXPECT_FALSE(static_cast<double>(v) > 1.1 * size) << size;
    EXPECT_FALSE(static_cast<double>(nearest.far) < 0.9 * size) << size;
    nearest = nearest_in_units(2 * size, 0, 1);
    nearest.to = {static_cast<float>(-p.x()), static_cast<float>(-p.y()),
                  static_cast<float>(-p.z())};
    nearest.size = std::numeric_limits<float>::infinity();
    nearest.beyond = std::numeric_limits<float>::infinity();
    EXPECT_EQ(nearer_of_eight(nearest, p, packed(triangles)), 0xffu) << size;
  }
}

}  // namespace
}  // namespace thimble::render
