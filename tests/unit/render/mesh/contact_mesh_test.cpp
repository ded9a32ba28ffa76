#include "mesh/contact_mesh.h"

#include <gtest/gtest.h>

#include "support/meshes/reference_geometry.h"
#include "support/meshes/shapes.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

TEST(ContactMesh, GivesNeighboursTheSameEdgePlaneWithOppositeSign) {
  for (const TriangleMesh& mesh :
       {support::bumpy_sphere(3, 0.05, 0.3, 6), support::wedge(0.08, 0.1, 0.1),
        support::needle(64, 0.1, 0.01), support::plate(0.1, 0.0002, 3)}) {
    const auto built = ContactMesh::build(mesh);
    ASSERT_TRUE(built.ok());
    for (std::int32_t t = 0; t < built->triangle_count(); ++t) {
      for (std::size_t k = 0; k < 3; ++k) {
        const Plane& mine = built->edge_planes(t)[k];
        const std::int32_t other = built->cell(t).neighbours[k];
        int negations = 0;
        for (std::size_t j = 0; j < 3; ++j) {
          const Plane& theirs = built->edge_planes(other)[j];
          negations +=
              built->cell(other).neighbours[j] == t && theirs.n == -mine.n && theirs.d == -mine.d;
        }
        EXPECT_EQ(negations, 1);
        EXPECT_NEAR(mine.n.norm(), 1, 1e-14);
      }
    }
  }
}

TEST(ContactMesh, ComputedEdgePlanesEqualStoredOnes) {
  for (const TriangleMesh& mesh :
       {support::bumpy_sphere(3, 0.05, 0.3, 6), support::wedge(0.08, 0.1, 0.1),
        support::plate(0.1, 0.0002, 3)}) {
    const auto kept = ContactMesh::build(mesh);
    const auto made = ContactMesh::build(mesh, {.edge_planes = false});
    const auto measured = ContactMesh::build(mesh, {.keep_planes = false});
    ASSERT_TRUE(kept.ok() && made.ok() && measured.ok());
    EXPECT_TRUE(kept->keeps_planes());
    EXPECT_FALSE(made->keeps_planes() || measured->keeps_planes());
    for (std::int32_t t = 0; t < kept->triangle_count(); ++t) {
      EXPECT_EQ(made->cell(t).face.n, kept->cell(t).face.n);
      EXPECT_EQ(made->cell(t).neighbours, kept->cell(t).neighbours);
      EXPECT_EQ(measured->cell(t).concave, kept->cell(t).concave);
      EXPECT_EQ(measured->cell(t).around, kept->cell(t).around);
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_EQ(made->edge_plane(t, k).n, kept->edge_planes(t)[k].n);
        EXPECT_EQ(made->edge_plane(t, k).d, kept->edge_planes(t)[k].d);
        EXPECT_EQ(made->concave_edge(t, k), kept->concave_edge(t, k));
      }
    }
  }
}

TEST(ContactMesh, PutsEdgePlanesThroughTheEdgeAndTheAverageNormal) {
  const TriangleMesh mesh = support::bumpy_sphere(3, 0.05, 0.3, 6);
  const auto built = ContactMesh::build(mesh);
  ASSERT_TRUE(built.ok());
  for (std::int32_t t = 0; t < built->triangle_count(); ++t) {
    const Vector3d middle =
        (built->position(t, 0) + built->position(t, 1) + built->position(t, 2)) / 3;
    for (std::size_t k = 0; k < 3; ++k) {
      const Plane& plane = built->edge_planes(t)[k];
      const auto other = static_cast<std::size_t>(built->cell(t).neighbours[k]);
      const Vector3d average = support::outward_normal(mesh, static_cast<std::size_t>(t)) +
                               support::outward_normal(mesh, other);
      EXPECT_NEAR(plane.distance(built->position(t, k) - built->origin()), 0, 1e-16);
      EXPECT_NEAR(plane.distance(built->position(t, (k + 1) % 3) - built->origin()), 0, 1e-16);
      EXPECT_NEAR(plane.n.dot(average), 0, 1e-12);
      EXPECT_GT(plane.distance(middle - built->origin()), 0);
    }
  }
}

TEST(ContactMesh, ReversesInsideOutPartsOnlyIfAllowed) {
  TriangleMesh mesh = support::icosphere(1, 1);
  for (auto& triangle : mesh.triangles) std::swap(triangle[0], triangle[1]);
  const auto turned = ContactMesh::build(mesh);
  ASSERT_TRUE(turned.ok());
  EXPECT_EQ(turned->turned_components(), 1u);
  EXPECT_GT(turned->depth(0, Vector3d::Zero()), 0);
  const auto refused = ContactMesh::build(mesh, {.orient = false});
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().message.find("normals pointing into"), std::string::npos);
}

TEST(ContactMesh, RefusesAFaultyMeshWithAllReasons) {
  TriangleMesh mesh = support::icosphere(1, 1);
  mesh.triangles.pop_back();
  std::swap(mesh.triangles[3][0], mesh.triangles[3][1]);
  const auto refused = ContactMesh::build(mesh);
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().message.find("has a hole"), std::string::npos);
  EXPECT_NE(refused.error().message.find("opposite orientation"), std::string::npos);
  EXPECT_FALSE(ContactMesh::build({}).ok());
}

}  // namespace
}  // namespace thimble::render
