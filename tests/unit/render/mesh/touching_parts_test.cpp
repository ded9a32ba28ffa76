#include "mesh/repair/touching_parts.h"

#include <gtest/gtest.h>

#include <limits>

#include "load_text.h"
#include "support/meshes/shapes.h"
#include "support/seed.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

// Adds a box of this half side to a mesh.
void add_box(TriangleMesh& mesh, const Vector3d& center, const Vector3d& half) {
  const auto first = static_cast<std::int32_t>(mesh.vertices.size());
  const TriangleMesh box = support::box(half);
  for (const Vector3d& vertex : box.vertices) mesh.vertices.push_back(vertex + center);
  for (const auto& [a, b, c] : box.triangles) {
    mesh.triangles.push_back({first + a, first + b, first + c});
  }
}

// Two boxes with a side of 2, the second moved.
TouchingParts parts_of_boxes(const Vector3d& moved) {
  TriangleMesh mesh;
  add_box(mesh, {0, 0, 0}, {1, 1, 1});
  add_box(mesh, moved, {1, 1, 1});
  return find_touching_parts(mesh);
}

TEST(TouchingParts, FindsPartsThatOverlap) {
  const TouchingParts found = parts_of_boxes({0.5, 0.4, 0.3});
  EXPECT_EQ(found.pairs, 1U);
  EXPECT_LT(found.triangles[0], 12);
  EXPECT_GE(found.triangles[1], 12);
  EXPECT_TRUE(found.complete);
}

TEST(TouchingParts, GiveAPointOfTheOverlap) {
  for (const Vector3d& moved :
       {Vector3d(0.5, 0.4, 0.3), Vector3d(1.9, 1.9, 1.9), Vector3d(-1.9, 0.2, 0.1),
        Vector3d(0.1, -1.8, 1.7), Vector3d(2, 0.4, 0.3), Vector3d(0, 0, 2)}) {
    const Vector3d place = parts_of_boxes(moved).place;
    EXPECT_LE(place.cwiseAbs().maxCoeff(), 1 + 1e-4) << moved.transpose();
    EXPECT_LE((place - moved).cwiseAbs().maxCoeff(), 1 + 1e-4) << moved.transpose();
  }
}

TEST(TouchingParts, FindsPartsThatAreFlush) {
  EXPECT_EQ(parts_of_boxes({2, 0.4, 0.3}).pairs, 1U);
  EXPECT_EQ(parts_of_boxes({2 + 1e-7, 0.4, 0.3}).pairs, 1U);
}

TEST(TouchingParts, FindsFlushPartsInSurveyCoordinates) {
  TriangleMesh mesh;
  add_box(mesh, {5e5, 4e6, 0}, {1, 1, 1});
  add_box(mesh, {5e5 + 2, 4e6 + 0.4, 0.3}, {1, 1, 1});
  EXPECT_EQ(find_touching_parts(mesh).pairs, 1U);
}

TEST(TouchingParts, FindsNothingBetweenPartsWithAGap) {
  EXPECT_EQ(parts_of_boxes({2.001, 0.4, 0.3}).pairs, 0U);
  // The boxes of the parts overlap, the parts do not.
  TriangleMesh balls = support::icosphere(3, 1);
  const auto first = static_cast<std::int32_t>(balls.vertices.size());
  const TriangleMesh other = balls;
  for (const Vector3d& vertex : other.vertices) {
    balls.vertices.push_back(vertex + Vector3d(1.2, 1.2, 1.2));
  }
  for (const auto& [a, b, c] : other.triangles) {
    balls.triangles.push_back({first + a, first + b, first + c});
  }
  EXPECT_EQ(find_touching_parts(balls).pairs, 0U);
}

TEST(TouchingParts, FindsNothingInAPartWithACavity) {
  TriangleMesh mesh;
  add_box(mesh, {0, 0, 0}, {1, 1, 1});
  add_box(mesh, {0, 0, 0}, {0.5, 0.5, 0.5});
  EXPECT_EQ(find_touching_parts(mesh).pairs, 0U);
}

TEST(TouchingParts, FindsNothingInOnePart) {
  EXPECT_EQ(find_touching_parts(support::icosphere(4, 1)).pairs, 0U);
  EXPECT_EQ(find_touching_parts({}).pairs, 0U);
}

TEST(TouchingParts, CountsEveryPairOnce) {
  TriangleMesh row;
  for (int i = 0; i < 5; ++i) add_box(row, {1.5 * i, 0.1 * i, 0.05 * i}, {1, 1, 1});
  EXPECT_EQ(find_touching_parts(row).pairs, 4U);
}

TEST(TouchingParts, AgreesWithEveryPairOfTriangles) {
  // Small boxes, some of which touch; the result for two axis-aligned boxes is known.
  std::vector<Vector3d> centers;
  auto seed = static_cast<std::uint32_t>(support::seed_of(5));
  const auto next = [&seed] {
    seed = seed * 1664525U + 1013904223U;
    return static_cast<double>(seed >> 8) / (1 << 24);
  };
  TriangleMesh mesh;
  for (int i = 0; i < 60; ++i) {
    centers.emplace_back(next(), next(), next());
    add_box(mesh, centers.back(), {0.06, 0.06, 0.06});
  }
  std::size_t wanted = 0;
  for (std::size_t i = 0; i < centers.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      wanted += (centers[i] - centers[k]).cwiseAbs().maxCoeff() <= 0.12;
    }
  }
  EXPECT_GT(wanted, 5U);
  EXPECT_EQ(find_touching_parts(mesh).pairs, wanted);
}

TEST(TouchingParts, AcceptsAnyMesh) {
  TriangleMesh mesh;
  add_box(mesh, {0, 0, 0}, {1, 1, 1});
  add_box(mesh, {0.5, 0, 0}, {1, 1, 1});
  mesh.vertices[0].x() = std::numeric_limits<double>::quiet_NaN();
  mesh.triangles.push_back({0, 99, -1});
  mesh.triangles.push_back({1, 1, 1});
  EXPECT_EQ(find_touching_parts(mesh).pairs, 1U);
}

TEST(TouchingParts, AreDescribedWithAPlaceAndARemedy) {
  EXPECT_EQ(describe(TouchingParts()), "");
  const auto mesh = load_mesh(kMeshFolder / "overlap.obj");
  ASSERT_TRUE(mesh.ok()) << mesh.error().message;
  const std::string text = describe(find_touching_parts(*mesh));
  EXPECT_EQ(text.substr(0, 70),
            "1 pair of parts overlap or lie flush against each other (first: triang");
  EXPECT_NE(text.find("Join them into one body in a mesh editor"), std::string::npos);
}

}  // namespace
}  // namespace thimble::render
