#include "compact_mesh/offset_triangle.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "support/dense_algebra.h"
#include "support/meshes/shapes.h"
#include "support/random.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

// The same by the definition, in double precision throughout.
class Definition {
 public:
  explicit Definition(const PackedTriangle& packed) {
    for (std::size_t k = 0; k < 3; ++k) {
      x[k] = packed.corner(k);
      n[k] = unpack_normal(packed.normals[k]);
    }
  }

  // Computes the weights and the depth by Newton's iteration on p = sum l_i (x_i - d n_i).
  void locate(const Vector3d& p) {
    Vector3d l1_l2_d(1.0 / 3, 1.0 / 3, 0);
    for (int round = 0; round < 20; ++round) {
      const double l1 = l1_l2_d[0], l2 = l1_l2_d[1], d = l1_l2_d[2];
      const Vector3d way = (1 - l1 - l2) * n[0] + l1 * n[1] + l2 * n[2];
      const Vector3d q = (1 - l1 - l2) * x[0] + l1 * x[1] + l2 * x[2];
      Eigen::Matrix3d slope;
      slope.col(0) = x[1] - x[0] - d * (n[1] - n[0]);
      slope.col(1) = x[2] - x[0] - d * (n[2] - n[0]);
      slope.col(2) = -way;
      l1_l2_d += support::solve(slope, p - q + d * way);
    }
    l = {1 - l1_l2_d[0] - l1_l2_d[1], l1_l2_d[0], l1_l2_d[1]};
    const Vector3d q = l[0] * x[0] + l[1] * x[1] + l[2] * x[2];
    const Vector3d sum = l[0] * n[0] + l[1] * n[1] + l[2] * n[2];
    const double size = sum.norm();
    normal = sum / size;
    double bend = 0;
    for (std::size_t k = 0; k < 3; ++k) bend += l[k] * (x[k] - q).dot(n[k]);
    const double below = (q - p).dot(normal);
    bend /= 1 + size;
    depth = below + bend;
    // A smooth surface below its triangles begins at the triangles and follows a parabola, up to
    // twice its depth.
    if (below >= 0 && below < -2 * bend) depth = below * below / (-4 * bend);
  }

  std::array<Vector3d, 3> x, n;
  std::array<double, 3> l{};
  Vector3d normal{0, 0, 0};
  double depth = 0;
};

TEST(OffsetTriangle, MatchesItsDefinition) {
  support::Random random(5);
  int places = 0;
  for (const TriangleMesh& mesh :
       {support::icosphere(1, 0.03), support::icosphere(4, 0.03),
        support::bumpy_sphere(3, 0.05, 0.2, 4), support::box({0.1, 0.1, 0.1})}) {
    const PackedSurface surface = PackedSurface::build(mesh).value();
    OffsetTriangle offset;
    for (int i = 0; i < 20000; ++i) {
      const auto t = static_cast<std::int32_t>(
          random.bits() % static_cast<std::uint64_t>(surface.triangle_count()));
      const PackedTriangle& packed = surface.triangle(t);
      offset.unpack(packed);
      Definition truth(packed);
      // Somewhere below the triangle, not deeper than its length.
      const double a = random.uniform(0, 1), b = random.uniform(0, 1 - a);
      const double edge = (truth.x[1] - truth.x[0]).norm();
      const double d = edge * random.uniform(-0.05, 0.3);
      const Vector3d p = (1 - a - b) * (truth.x[0] - d * truth.n[0]) +
                         a * (truth.x[1] - d * truth.n[1]) + b * (truth.x[2] - d * truth.n[2]);
      const OffsetPlace place = offset.locate(p);
      if (!place.valid) continue;
      truth.locate(p);
      ++places;
      ASSERT_NEAR(place.l0, truth.l[0], 1e-6);
      ASSERT_NEAR(place.l1, truth.l[1], 1e-6);
      ASSERT_NEAR(place.l2, truth.l[2], 1e-6);
      ASSERT_NEAR(place.depth, d, 3e-7 * std::abs(d) + 1);
      if (std::min({place.l0, place.l1, place.l2}) < 0) continue;
      const OffsetResponse felt = offset.feel(place);
      ASSERT_NEAR(felt.depth, truth.depth, 3e-7 * std::abs(d) + 1e-7 * edge);
      ASSERT_LT((felt.n_W - truth.normal).norm(), 1e-6);
      ASSERT_NEAR(felt.n_W.norm(), 1, 1e-14);
    }
  }
  EXPECT_GT(places, 70000);
}

TEST(OffsetTriangle, GivesTheWholeSizeOfALatticeItsRightSides) {
  // A face of a cube of the lattice's size: differences of its corners need 33 bits.
  const PackedSurface surface = PackedSurface::build(support::box({0.1, 0.1, 0.1})).value();
  OffsetTriangle offset;
  for (std::int32_t t = 0; t < surface.triangle_count(); ++t) {
    const PackedTriangle& packed = surface.triangle(t);
    offset.unpack(packed);
    const Vector3d middle = (packed.corner(0) + packed.corner(1) + packed.corner(2)) / 3;
    const OffsetPlace place = offset.locate(middle - 1e6 * offset.face());
    ASSERT_TRUE(place.valid);
    EXPECT_NEAR(place.l0, 1.0 / 3, 1e-12);
    EXPECT_NEAR(place.l1, 1.0 / 3, 1e-12);
    EXPECT_NEAR(place.depth, 1e6, 1e-3);
    EXPECT_EQ(offset.creases() != 0, true);
  }
}

TEST(OffsetTriangle, IsInvalidWhereItIsFoldedOverAndForNaN) {
  const PackedSurface surface = PackedSurface::build(support::icosphere(2, 0.03)).value();
  OffsetTriangle offset;
  offset.unpack(surface.triangle(0));
  // Beyond the middle of the ball, where the corners' normals have crossed.
  EXPECT_FALSE(offset.locate(-1.5 * kLatticeHalf * offset.face()).valid);
  EXPECT_FALSE(offset.locate(Vector3d(std::nan(""), 0, 0)).valid);
  EXPECT_TRUE(offset.locate(0.5 * kLatticeHalf * offset.face()).valid);
}

}  // namespace
}  // namespace thimble::render
