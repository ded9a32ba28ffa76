#include "mesh/smooth_normals.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "mesh/vertex_normals.h"
#include "support/meshes/reference_geometry.h"
#include "support/meshes/shapes.h"
#include "support/meshes/smooth_surfaces.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

ContactMesh prepared_mesh(const TriangleMesh& mesh) {
  return ContactMesh::build(mesh).value();
}

TEST(VertexNormals, DoNotDependOnHowFlatGroundIsCutUp) {
  TriangleMesh mesh = support::box({0.01, 0.02, 0.03});
  const std::vector<Vector3d> first = vertex_normals(mesh);
  // The other diagonal of the upper and lower face.
  mesh.triangles[0] = {0, 2, 1};
  mesh.triangles[1] = {2, 3, 1};
  mesh.triangles[2] = {4, 5, 6};
  mesh.triangles[3] = {5, 7, 6};
  const std::vector<Vector3d> second = vertex_normals(mesh);
  for (std::size_t v = 0; v < 8; ++v) {
    const Vector3d wanted = mesh.vertices[v].cwiseSign() / std::sqrt(3.0);
    EXPECT_LT((first[v] - wanted).norm(), 1e-15);
    EXPECT_LT((second[v] - wanted).norm(), 1e-15);
  }
}

TEST(VertexNormals, ErrorOnATorusFallsWithTheSquaredEdge) {
  const support::TorusSurface surface{0.05, 0.02};
  double before = 0;
  for (const int fine : {1, 2, 4}) {
    const TriangleMesh mesh = support::torus(0.05, 0.02, 32 * fine, 16 * fine);
    const std::vector<Vector3d> normals = vertex_normals(mesh);
    double worst = 0;
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
      const Vector3d wanted = support::unit_normal(surface, mesh.vertices[v]);
      worst = std::max(worst, (normals[v] - wanted).norm());
    }
    if (fine > 1) {
      EXPECT_NEAR(before / worst, 4, 0.5);
    }
    before = worst;
  }
  EXPECT_LT(before, 1e-3);
}

TEST(SmoothNormals, BoxFacesKeepTheirExactNormals) {
  const ContactMesh mesh = prepared_mesh(support::box({0.01, 0.02, 0.03}));
  const SmoothNormals normals(mesh);
  int creases = 0;
  for (std::int32_t t = 0; t < mesh.triangle_count(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_LT((normals.corners(t)[k] - mesh.cell(t).face.n).norm(), 1e-15);
      creases += normals.crease(t, k);
    }
  }
  EXPECT_EQ(creases, 24);  // 12 edges, each counted from both sides
}

TEST(SmoothNormals, AgreeOnBothSidesOfASmoothEdge) {
  int smooth = 0;
  int creases = 0;
  for (const TriangleMesh& shape :
       {support::bumpy_sphere(3, 0.05, 0.5, 9), support::needle(12, 0.05, 0.01),
        support::torus(0.05, 0.02, 9, 5), support::wedge(0.3, 0.05, 0.05)}) {
    const ContactMesh mesh = prepared_mesh(shape);
    for (const double angle : {0.1, 0.5, kCreaseAngle, 2.0}) {
      const SmoothNormals normals(mesh, angle);
      for (std::int32_t t = 0; t < mesh.triangle_count(); ++t) {
        for (std::size_t k = 0; k < 3; ++k) {
          const std::int32_t other = mesh.cell(t).neighbours[k];
          std::size_t j = 0;
          while (mesh.corners(other)[(j + 1) % 3] != mesh.corners(t)[k]) ++j;
          EXPECT_EQ(normals.crease(t, k), normals.crease(other, j));
          (normals.crease(t, k) ? creases : smooth) += 1;
          if (normals.crease(t, k)) continue;
          EXPECT_EQ(normals.corners(t)[k], normals.corners(other)[(j + 1) % 3]);
          EXPECT_EQ(normals.corners(t)[(k + 1) % 3], normals.corners(other)[j]);
        }
      }
    }
  }
  EXPECT_GT(smooth, 1000);
  EXPECT_GT(creases, 1000);
}

TEST(SmoothNormals, WeightedByAnglesAreTheNormalsOfTheVertices) {
  const TriangleMesh shape = support::bumpy_sphere(3, 0.05, 0.5, 9);
  const ContactMesh mesh = prepared_mesh(shape);
  const SmoothNormals normals(mesh, std::numbers::pi, NormalWeights::kAngle, std::numbers::pi);
  const std::vector<Vector3d> wanted = vertex_normals(shape);
  for (std::int32_t t = 0; t < mesh.triangle_count(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto v = static_cast<std::size_t>(mesh.corners(t)[k]);
      EXPECT_LT((normals.corners(t)[k] - wanted[v]).norm(), 1e-13);
    }
  }
}

TEST(SmoothNormals, WithRoundWeightsAreExactOnAnyMeshOfASphere) {
  TriangleMesh shape = support::icosphere(3, 1);
  for (Vector3d& p : shape.vertices) {
    p.z() *= 2.5;  // triangles of all shapes, still on the sphere
    p = 0.05 * p.normalized();
  }
  const ContactMesh mesh = prepared_mesh(shape);
  const SmoothNormals round(mesh, kCreaseAngle, NormalWeights::kRound);
  const SmoothNormals angle(mesh, kCreaseAngle, NormalWeights::kAngle);
  double worst_angle = 0;
  for (std::int32_t t = 0; t < mesh.triangle_count(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3d wanted = mesh.position(t, k).normalized();
      EXPECT_LT((round.corners(t)[k] - wanted).norm(), 1e-13);
      worst_angle = std::max(worst_angle, (angle.corners(t)[k] - wanted).norm());
    }
  }
  EXPECT_GT(worst_angle, 1e-3);
}

TEST(SmoothNormals, FittedNormalsAreExactOnFlatGround) {
  const ContactMesh mesh = prepared_mesh(support::plate(0.05, 0.004, 7));
  const SmoothNormals normals(mesh);
  for (std::int32_t t = 0; t < mesh.triangle_count(); ++t) {
    for (const Vector3d& n : normals.corners(t)) {
      EXPECT_LT((n - mesh.cell(t).face.n).norm(), 1e-13);
    }
  }
}

TEST(SmoothNormals, FittedNormalsFaceAllFacesOfANeedle) {
  // The vertices of a needle are not a paraboloid: there the mean of the faces must be used.
  const ContactMesh mesh = prepared_mesh(support::needle(64, 0.05, 0.002));
  const SmoothNormals fitted(mesh, std::numbers::pi);
  const SmoothNormals angle(mesh, std::numbers::pi, NormalWeights::kAngle);
  for (std::int32_t t = 0; t < mesh.triangle_count(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double lean = mesh.cell(t).face.n.dot(fitted.corners(t)[k]);
      EXPECT_GE(lean, std::min(0.5, mesh.cell(t).face.n.dot(angle.corners(t)[k]) - 1e-12));
    }
  }
}

}  // namespace
}  // namespace thimble::render
