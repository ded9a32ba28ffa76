#include "thimble/render/mesh/check_mesh.h"

#include <gtest/gtest.h>

#include <limits>
#include <utility>

#include "mesh/repair/orient_mesh.h"
#include "support/meshes/shapes.h"

namespace thimble::render {
namespace {

using Kind = MeshFault::Kind;

std::size_t count(const MeshFindings& findings, Kind kind) {
  for (const MeshFault& fault : findings.faults) {
    if (fault.kind == kind) return fault.count;
  }
  return 0;
}

void append(TriangleMesh& mesh, const TriangleMesh& other) {
  const auto shift = static_cast<std::int32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const auto& [a, b, c] : other.triangles) {
    mesh.triangles.push_back({a + shift, b + shift, c + shift});
  }
}

TriangleMesh turned(TriangleMesh mesh) {
  for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  return mesh;
}

TEST(CheckMesh, FindsNoFaultInClosedShapesAndMeasuresThem) {
  const MeshFindings box = check_mesh(support::box({0.5, 1, 1.5}));
  EXPECT_TRUE(box.touchable());
  EXPECT_DOUBLE_EQ(box.volume, 6);
  EXPECT_DOUBLE_EQ(box.area, 22);
  EXPECT_EQ(box.edges, 18u);
  EXPECT_EQ(box.euler_characteristic, 2);
  EXPECT_EQ(check_mesh(support::torus(3, 1, 12, 8)).euler_characteristic, 0);
  for (const TriangleMesh& mesh :
       {support::icosphere(2, 1), support::torus(3, 1, 12, 8), support::plate(1, 0.01, 4),
        support::needle(64, 1, 0.1), support::wedge(0.1, 1, 1),
        support::bumpy_sphere(3, 1, 0.3, 6)}) {
    EXPECT_TRUE(check_mesh(mesh).touchable());
  }
}

TEST(CheckMesh, CountsTheThreeOpenEdgesOfAMissingTriangle) {
  TriangleMesh mesh = support::icosphere(1, 1);
  mesh.triangles.pop_back();
  const MeshFindings findings = check_mesh(mesh);
  EXPECT_EQ(count(findings, Kind::kOpenEdge), 3u);
  EXPECT_FALSE(findings.touchable());
}

TEST(CheckMesh, FindsAFinOnAClosedMesh) {
  TriangleMesh mesh = support::box({1, 1, 1});
  mesh.triangles.push_back({0, 1, support::add_vertex(mesh, {0, -2, -2})});
  const MeshFindings findings = check_mesh(mesh);
  EXPECT_EQ(count(findings, Kind::kNonManifoldEdge), 1u);
  EXPECT_EQ(count(findings, Kind::kOpenEdge), 2u);
}

TEST(CheckMesh, FindsTheThreeEdgesOfAFlippedTriangle) {
  TriangleMesh mesh = support::icosphere(1, 1);
  std::swap(mesh.triangles[5][0], mesh.triangles[5][1]);
  EXPECT_EQ(count(check_mesh(mesh), Kind::kFlippedEdge), 3u);
}

TEST(CheckMesh, FindsAVertexWhereTwoPartsTouch) {
  TriangleMesh mesh = support::box({1, 1, 1});
  TriangleMesh other = support::box({1, 1, 1});
  for (auto& p : other.vertices) p += Eigen::Vector3d(2, 2, 2);
  append(mesh, other);
  for (auto& triangle : mesh.triangles) {
    for (auto& v : triangle) {
      if (v == 8) v = 7;
    }
  }
  const MeshFindings findings = check_mesh(mesh);
  ASSERT_EQ(findings.faults.size(), 1u);
  EXPECT_EQ(count(findings, Kind::kNonManifoldVertex), 1u);
  EXPECT_EQ(findings.unused_vertices, 1u);
  EXPECT_EQ(findings.components, 2u);
}

TEST(CheckMesh, FindsDegenerateTrianglesAtEveryScale) {
  for (const double scale : {1e-9, 1.0, 1e9}) {
    TriangleMesh mesh = support::box({scale, scale, scale});
    mesh.triangles.push_back({0, 0, 1});
    const std::int32_t middle =
        support::add_vertex(mesh, (mesh.vertices[0] + mesh.vertices[1]) / 2);
    mesh.triangles.push_back({0, middle, 1});
    EXPECT_EQ(count(check_mesh(mesh), Kind::kDegenerateTriangle), 2u) << scale;
    // A sliver with a height of a millionth of its length is thin, not degenerate.
    TriangleMesh sliver = support::box({scale, scale, 1e-6 * scale});
    EXPECT_TRUE(check_mesh(sliver).touchable()) << scale;
  }
}

TEST(CheckMesh, FindsInvalidNumbersAndIndices) {
  TriangleMesh mesh = support::box({1, 1, 1});
  mesh.vertices[3].y() = std::numeric_limits<double>::quiet_NaN();
  mesh.triangles.push_back({0, 1, 99});
  mesh.triangles.push_back({-1, 1, 2});
  mesh.triangles.push_back({4, 7, 5});
  const MeshFindings findings = check_mesh(mesh);
  EXPECT_EQ(count(findings, Kind::kNotFinite), 1u);
  EXPECT_EQ(count(findings, Kind::kIndexOutOfRange), 2u);
  EXPECT_EQ(count(findings, Kind::kDuplicateTriangle), 1u);
  EXPECT_FALSE(check_mesh({}).touchable());
}

TEST(CheckMesh, DistinguishesCavitiesFromInsideOutParts) {
  EXPECT_EQ(count(check_mesh(turned(support::box({1, 1, 1}))), Kind::kInsideOut), 1u);
  TriangleMesh shell = support::icosphere(2, 3);
  append(shell, turned(support::icosphere(2, 2)));
  append(shell, support::icosphere(2, 1));
  EXPECT_TRUE(check_mesh(shell).touchable());
  TriangleMesh wrong = support::icosphere(2, 3);
  append(wrong, support::icosphere(2, 2));
  EXPECT_EQ(count(check_mesh(wrong), Kind::kInsideOut), 1u);
  EXPECT_EQ(orient_mesh(wrong).turned_components, 1u);
  EXPECT_TRUE(check_mesh(wrong).touchable());
}

TEST(CheckMesh, DescribesAFaultWithCountPlaceAndRemedy) {
  EXPECT_EQ(describe({Kind::kOpenEdge, 3, "edge 1-2 near (0, 0, 0)"}),
            "3 edges belong to only one triangle, so the mesh has a hole (the first: edge 1-2 near "
            "(0, 0, 0)); a repair fills holes, and open parts can be used as sheets.");
  EXPECT_EQ(describe({Kind::kDegenerateTriangle, 1, "triangle 4"}),
            "1 triangle has no area (triangle 4); a repair drops such triangles.");
}

}  // namespace
}  // namespace thimble::render
