#include "view/gl/creased_mesh.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "mesh/vertex_normals.h"
#include "support/meshes/shapes.h"
#include "support/random.h"

namespace thimble::view {
namespace {

constexpr double kSharp = 0.87;

TEST(CreasedMesh, GivesEachFaceOfABoxItsOwnNormal) {
  const render::TriangleMesh box = support::box({1, 2, 3});
  const CreasedMesh drawn = crease(box, kSharp);
  EXPECT_EQ(drawn.positions.size(), 24U);
  for (const Eigen::Vector3f& normal : drawn.normals) {
    EXPECT_FLOAT_EQ(normal.cwiseAbs().maxCoeff(), 1.0F);
  }
  EXPECT_EQ(drawn.edges.size(), 18U);
}

TEST(CreasedMesh, EqualsMeshWithoutSharpEdges) {
  const render::TriangleMesh ball = support::icosphere(3, 1.0);
  const CreasedMesh drawn = crease(ball, kSharp);
  ASSERT_EQ(drawn.positions.size(), ball.vertices.size());
  const auto normals = render::vertex_normals(ball);
  for (std::size_t t = 0; t < ball.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto vertex = static_cast<std::size_t>(ball.triangles[t][k]);
      EXPECT_LT(
          (drawn.positions[drawn.triangles[t][k]] - ball.vertices[vertex].cast<float>()).norm(),
          1e-6F);
      EXPECT_LT((drawn.normals[drawn.triangles[t][k]] - normals[vertex].cast<float>()).norm(),
                1e-5F);
    }
  }
}

TEST(CreasedMesh, ClosedMeshHasTwoSidesPerEdge) {
  render::TriangleMesh ball = support::icosphere(1, 1.0);
  EXPECT_TRUE(crease(ball, kSharp).closed);
  EXPECT_TRUE(crease(support::box({1, 2, 3}), kSharp).closed);
  render::TriangleMesh turned = ball;
  for (auto& triangle : turned.triangles) std::swap(triangle[0], triangle[1]);
  EXPECT_FALSE(crease(turned, kSharp).closed);
  std::swap(ball.triangles[3][0], ball.triangles[3][1]);
  EXPECT_FALSE(crease(ball, kSharp).closed);
  render::TriangleMesh open = support::icosphere(1, 1.0);
  open.triangles.pop_back();
  EXPECT_FALSE(crease(open, kSharp).closed);
  EXPECT_FALSE(crease({}, kSharp).closed);
}

TEST(CreasedMesh, IgnoresDegenerateTrianglesAndSpikes) {
  render::TriangleMesh bad;
  bad.vertices = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}};
  bad.triangles = {{0, 1, 2}, {0, 1, 3}, {0, 0, 1}};
  for (const Eigen::Vector3f& normal : crease(bad, kSharp).normals) {
    EXPECT_TRUE(normal.allFinite());
    EXPECT_LE(normal.norm(), 1.0F + 1e-6F);
  }
}

}  // namespace
}  // namespace thimble::view
