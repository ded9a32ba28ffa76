#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "mesh/adjacency.h"
#include "mesh/file/weld_mesh.h"
#include "support/meshes/shapes.h"
#include "thimble/render/mesh/check_mesh.h"
#include "thimble/render/mesh/mesh_file.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

TEST(WeldMesh, JoinsExactlyEqualPlacesAndNothingElse) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {-0.0, 0, 0}, {1 + 1e-15, 0, 0}, {1, 0, 0}};
  mesh.triangles = {{0, 1, 3}, {2, 4, 3}};
  const TriangleMesh welded = weld_mesh(mesh);
  EXPECT_EQ(welded.vertices.size(), 3u);
  EXPECT_EQ(welded.triangles[0], welded.triangles[1]);
}

TEST(WeldMesh, ClosesATriangleSoup) {
  const TriangleMesh mesh = support::icosphere(2, 1);
  TriangleMesh soup;
  for (const auto& triangle : mesh.triangles) {
    const auto first = static_cast<std::int32_t>(soup.vertices.size());
    for (const auto v : triangle)
      soup.vertices.push_back(mesh.vertices[static_cast<std::size_t>(v)]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  EXPECT_FALSE(check_mesh(soup).touchable());
  EXPECT_TRUE(check_mesh(weld_mesh(soup)).touchable());
}

TEST(PlacedMesh, KeepsItsOutsideForEveryScale) {
  const Eigen::Matrix3d R_WO = Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()).matrix();
  for (const double scale : {0.001, 2.0, -2.0}) {
    const MeshFindings findings =
        check_mesh(placed(support::box({0.5, 1, 1.5}), scale, R_WO, {1, 2, 3}));
    EXPECT_TRUE(findings.touchable());
    EXPECT_NEAR(findings.volume / std::abs(scale * scale * scale), 6, 1e-9);
    EXPECT_NEAR(((findings.box_min + findings.box_max) / 2 - Vector3d(1, 2, 3)).norm(), 0, 1e-12);
  }
}

TEST(Adjacency, IsMutualAndSharesTheEdgeItNames) {
  const TriangleMesh mesh = support::torus(3, 1, 20, 10);
  const auto found = find_adjacency(mesh);
  ASSERT_TRUE(found.ok());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto other = static_cast<std::size_t>((*found)[t][k]);
      bool back = false;
      for (std::size_t j = 0; j < 3; ++j) {
        back |= static_cast<std::size_t>((*found)[other][j]) == t &&
                mesh.triangles[other][j] == mesh.triangles[t][(k + 1) % 3] &&
                mesh.triangles[other][(j + 1) % 3] == mesh.triangles[t][k];
      }
      EXPECT_TRUE(back) << t << " over edge " << k;
    }
  }
}

TEST(Adjacency, IsRefusedWithAReason) {
  TriangleMesh open = support::box({1, 1, 1});
  open.triangles.pop_back();
  EXPECT_NE(find_adjacency(open).error().message.find("so the mesh has a hole"), std::string::npos);
  TriangleMesh fin = support::box({1, 1, 1});
  fin.triangles.push_back({0, 3, 5});
  EXPECT_NE(find_adjacency(fin).error().message.find("3 triangles"), std::string::npos);
  TriangleMesh flipped = support::box({1, 1, 1});
  std::swap(flipped.triangles[0][0], flipped.triangles[0][1]);
  EXPECT_NE(find_adjacency(flipped).error().message.find("opposite orientation"),
            std::string::npos);
  TriangleMesh broken = support::box({1, 1, 1});
  broken.triangles[0][0] = 77;
  EXPECT_NE(find_adjacency(broken).error().message.find("Triangle 0"), std::string::npos);
}

}  // namespace
}  // namespace thimble::render
