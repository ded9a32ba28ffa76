#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <vector>

#include "mesh/closest_point.h"
#include "mesh/repair/open_edges.h"
#include "mesh/repair/sheet_wedges.h"
#include "support/random.h"
#include "thimble/render/mesh/check_mesh.h"
#include "thimble/render/mesh/repair_mesh.h"

// Single steps of repair_mesh and thicken_sheets.

namespace thimble::render {
namespace {

using Eigen::Vector3d;

TEST(WeldOpenEdges, KeepsInvalidVertexNumbers) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1e-9, 0, 0}, {0, 0, 1}, {0, 1, 1}};
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}, {-1, 99, 0}, {-7, 1'000'000'000, 3}};
  EXPECT_EQ(weld_open_edges(mesh, 1e-6), (std::vector<std::int32_t>{3}));
  EXPECT_EQ(mesh.triangles[1], (std::array<std::int32_t, 3>{0, 4, 5}));
  EXPECT_EQ(mesh.triangles[2], (std::array<std::int32_t, 3>{-1, 99, 0}));
  EXPECT_EQ(mesh.triangles[3], (std::array<std::int32_t, 3>{-7, 1'000'000'000, 0}));
}

TEST(RepairMesh, SeparatesBodiesThatTouchAlongASplitEdge) {
  // Two prisms over triangles that share the edge x = y = 0, which has a vertex in its middle: at
  // that vertex the faces of each body are connected only across the split edge.
  TriangleMesh mesh;
  const auto add = [&mesh](double x, double y, double z) {
    mesh.vertices.emplace_back(x, y, z);
    return static_cast<std::int32_t>(mesh.vertices.size() - 1);
  };
  std::array<std::int32_t, 3> shared{};
  for (std::size_t i = 0; i < 3; ++i) shared[i] = add(0, 0, static_cast<double>(i));
  for (const double side : {1.0, -1.0}) {
    std::array<std::int32_t, 3> right{}, left{};
    for (std::size_t i = 0; i < 3; ++i) right[i] = add(side, -0.5 * side, static_cast<double>(i));
    for (std::size_t i = 0; i < 3; ++i) left[i] = add(side, 0.5 * side, static_cast<double>(i));
    const std::array<std::array<std::int32_t, 3>, 3> columns{shared, right, left};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& a = columns[k];
      const auto& b = columns[(k + 1) % 3];
      for (std::size_t i = 0; i < 2; ++i) {
        mesh.triangles.push_back({a[i], b[i], b[i + 1]});
        mesh.triangles.push_back({a[i], b[i + 1], a[i + 1]});
      }
    }
    mesh.triangles.push_back({shared[0], left[0], right[0]});
    mesh.triangles.push_back({shared[2], right[2], left[2]});
  }
  ASSERT_FALSE(check_mesh(mesh).touchable());
  const RepairedMesh repaired = repair_mesh(mesh);
  EXPECT_TRUE(check_mesh(repaired.mesh).touchable());
  EXPECT_EQ(repaired.mesh.triangles.size(), mesh.triangles.size());
  EXPECT_EQ(repaired.mesh.vertices.size(), 18u);  // nine per body
}

TEST(AmbiguousEdges, AreSplitIntoPiecesWithKnownTriangles) {
  // Randomly connected triangles: at some edges, front and back coincide at both ends.
  support::Random random(5);
  std::size_t cuts = 0;
  for (int i = 0; i < 50; ++i) {
    TriangleMesh mesh;
    for (int v = 0; v < 6; ++v) mesh.vertices.push_back(random.in_box(1));
    for (int t = 0; t < 8; ++t) {
      const auto a = static_cast<std::int32_t>(random.bits() % 6);
      const auto step = static_cast<std::int32_t>(1 + random.bits() % 2);
      mesh.triangles.push_back({a, (a + step) % 6, (a + 2 * step + 1) % 6});
    }
    const CutMesh cut = with_ambiguous_edges_cut(mesh);
    ASSERT_EQ(cut.sources.size(), cut.mesh.triangles.size());
    cuts += cut.mesh.triangles.size() - mesh.triangles.size();
    for (std::size_t k = 0; k < cut.sources.size(); ++k) {
      const auto corner = [&mesh, &cut, k](std::size_t n) {
        return mesh.vertices[static_cast<std::size_t>(
            mesh.triangles[static_cast<std::size_t>(cut.sources[k])][n])];
      };
      for (const std::int32_t v : cut.mesh.triangles[k]) {
        const Vector3d& p = cut.mesh.vertices[static_cast<std::size_t>(v)];
        EXPECT_LT((closest_point(p, corner(0), corner(1), corner(2)) - p).norm(), 1e-12) << k;
      }
    }
  }
  EXPECT_GT(cuts, 10u);
}

}  // namespace
}  // namespace thimble::render
