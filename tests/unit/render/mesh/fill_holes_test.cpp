#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "mesh/contact_mesh.h"
#include "mesh/repair/orient_mesh.h"
#include "support/meshes/shapes.h"
#include "support/random.h"
#include "thimble/render/mesh/check_mesh.h"
#include "thimble/render/mesh/repair_mesh.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;
using Kind = RepairChange::Kind;

std::size_t count(const RepairedMesh& repaired, Kind kind) {
  for (const RepairChange& change : repaired.changes) {
    if (change.kind == kind) return change.count;
  }
  return 0;
}

template <class IsGone>
TriangleMesh without(TriangleMesh mesh, IsGone is_gone) {
  std::erase_if(mesh.triangles, [&](const auto& t) {
    return is_gone((mesh.vertices[static_cast<std::size_t>(t[0])] +
                    mesh.vertices[static_cast<std::size_t>(t[1])] +
                    mesh.vertices[static_cast<std::size_t>(t[2])]) /
                   3);
  });
  return mesh;
}

TEST(FillHoles, ClosesABoxWithoutLidByAFlatOne) {
  const TriangleMesh open =
      without(support::box({1, 2, 3}), [](const Vector3d& p) { return p.z() > 2.9; });
  ASSERT_EQ(open.triangles.size(), 10u);
  const RepairedMesh repaired = repair_mesh(open);
  EXPECT_EQ(count(repaired, Kind::kFilledHole), 1u);
  const MeshFindings found = check_mesh(repaired.mesh);
  EXPECT_TRUE(found.touchable());
  EXPECT_EQ(found.triangles, 12u);
  EXPECT_DOUBLE_EQ(found.volume, 48);
  const std::string reported = describe(repaired.changes.back());
  EXPECT_NE(reported.find("1 hole was filled (4 edges"), std::string::npos) << reported;
}

TEST(FillHoles, ClosesAHoleInACurvedSurfaceWithoutASpikeOrADent) {
  for (const double opening : {0.2, 0.4, 0.7}) {  // rad, from the hole's centre to its rim
    const TriangleMesh ball = support::icosphere(4, 1);
    const RepairedMesh repaired = repair_mesh(
        without(ball, [&](const Vector3d& p) { return std::acos(p.normalized().z()) < opening; }));
    const MeshFindings found = check_mesh(repaired.mesh);
    ASSERT_TRUE(found.touchable()) << opening;
    EXPECT_EQ(found.euler_characteristic, 2) << opening;
    // The missing volume is at most the cap over the plane of the rim.
    const double height = 1 - std::cos(opening + 0.05);
    const double cap = std::numbers::pi * height * height * (3 - height) / 3;
    EXPECT_GT(found.volume, check_mesh(ball).volume - cap) << opening;
    EXPECT_LE(found.volume, check_mesh(ball).volume) << opening;
    // A fold would add area.
    EXPECT_LT(found.area, check_mesh(ball).area + 0.01) << opening;
  }
}

TEST(FillHoles, ClosesWholePartsOrNoneAndRecognisesASheet) {
  const TriangleMesh ball = support::icosphere(3, 1);
  const auto bowl = without(ball, [](const Vector3d& p) { return p.z() > -0.2; });
  EXPECT_EQ(count(repair_mesh(bowl), Kind::kFilledHole), 0u);  // more than half of its area
  RepairOptions most;
  most.hole_share = 1;
  EXPECT_TRUE(check_mesh(repair_mesh(bowl, most).mesh).touchable());
  RepairOptions none;
  none.hole_share = 0;
  const auto small = without(ball, [](const Vector3d& p) { return p.z() > 0.95; });
  EXPECT_FALSE(check_mesh(repair_mesh(small, none).mesh).touchable());
  EXPECT_TRUE(check_mesh(repair_mesh(small).mesh).touchable());

  // A washer: its inner hole is small, and its outer rim is not a hole.
  TriangleMesh washer;
  for (int i = 0; i < 24; ++i) {
    const double a = 2 * std::numbers::pi * i / 24;
    washer.vertices.emplace_back(std::cos(a), std::sin(a), 0);
    washer.vertices.emplace_back(0.2 * std::cos(a), 0.2 * std::sin(a), 0);
  }
  for (int i = 0; i < 24; ++i) {
    const int a = 2 * i, b = 2 * ((i + 1) % 24);
    washer.triangles.push_back({a, b, a + 1});
    washer.triangles.push_back({b, b + 1, a + 1});
  }
  const RepairedMesh same = repair_mesh(washer);
  EXPECT_EQ(same.mesh.triangles, washer.triangles);
}

TEST(FillHoles, LongRimIsNotAHole) {
  for (const int edges : {1500, 2500}) {
    TriangleMesh cup;  // a long cup, whose lid would be a thirtieth of its area
    cup.vertices = {{0, 0, -3}};
    for (int i = 0; i < edges; ++i) {
      const double a = 2 * std::numbers::pi * i / edges;
      cup.vertices.emplace_back(0.1 * std::cos(a), 0.1 * std::sin(a), 0);
    }
    for (int i = 0; i < edges; ++i) cup.triangles.push_back({0, 1 + (i + 1) % edges, 1 + i});
    EXPECT_EQ(check_mesh(repair_mesh(cup).mesh).touchable(), edges < 2000) << edges;
  }
}

TEST(FillHoles, MergesACornerThatAHoleVisitsTwice) {
  TriangleMesh mesh = support::icosphere(2, 1);
  // Two triangles of a fan that share only its vertex.
  const std::int32_t vertex = mesh.triangles[0][0];
  std::vector<std::size_t> fan;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& corners = mesh.triangles[t];
    if (std::find(corners.begin(), corners.end(), vertex) != corners.end()) fan.push_back(t);
  }
  std::set<std::int32_t> of_first(mesh.triangles[fan[0]].begin(), mesh.triangles[fan[0]].end());
  std::size_t other = 0;
  for (const std::size_t t : fan) {
    int shared = 0;
    for (const std::int32_t v : mesh.triangles[t]) shared += of_first.contains(v);
    if (shared == 1) other = t;
  }
  ASSERT_NE(other, 0u);
  const std::size_t before = mesh.triangles.size();
  mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(other));
  mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(fan[0]));
  const RepairedMesh repaired = repair_mesh(mesh);
  EXPECT_TRUE(check_mesh(repaired.mesh).touchable());
  EXPECT_EQ(repaired.mesh.triangles.size(), before);
  EXPECT_EQ(repaired.mesh.vertices.size(), mesh.vertices.size());
  EXPECT_EQ(check_mesh(repaired.mesh).euler_characteristic, 2);
}

TEST(FillHoles, ClosesWhateverIsTornOutAtRandom) {
  support::Random random(5);
  int closed = 0;
  constexpr int kRounds = 200;
  for (int round = 0; round < kRounds; ++round) {
    const TriangleMesh whole =
        round % 2 == 0 ? support::bumpy_sphere(3, 1, 0.2, 5) : support::torus(1, 0.4, 24, 12);
    TriangleMesh torn = whole;
    const double share = random.uniform(0.002, 0.15);
    std::erase_if(torn.triangles, [&](const auto&) { return random.uniform(0, 1) < share; });
    const RepairedMesh repaired = repair_mesh(torn);
    const MeshFindings found = check_mesh(repaired.mesh);
    for (const MeshFault& fault : found.faults) {
      // The rest may be open; a filling creates no other fault.
      EXPECT_EQ(fault.kind, MeshFault::Kind::kOpenEdge) << round << ": " << describe(fault);
    }
    // Fragments that lost all their neighbours are sheets; the body is complete.
    const MeshComponents parts = find_components(repaired.mesh, sorted_edge_uses(repaired.mesh));
    std::vector<std::size_t> size(parts.count, 0);
    for (const std::int32_t part : parts.component_of) ++size[static_cast<std::size_t>(part)];
    const auto largest = std::max_element(size.begin(), size.end()) - size.begin();
    closed += parts.closed[static_cast<std::size_t>(largest)];
  }
  EXPECT_GE(closed, kRounds * 99 / 100);
}

TEST(SplitFans, PartsBodiesThatTouchAtAnEdge) {
  support::Random random(9);
  for (const bool turned : {false, true}) {
    TriangleMesh mesh = support::box({1, 1, 1});
    const TriangleMesh other = support::box({1, 1, 1});
    // Shifted by (2, 2, 0): its edge of vertices 0 and 4 is the first's of 3 and 7.
    for (const Vector3d& p : other.vertices) mesh.vertices.push_back(p + Vector3d(2, 2, 0));
    for (auto triangle : other.triangles) {
      for (auto& v : triangle) v = v == 0 ? 3 : v == 4 ? 7 : v + 8;
      mesh.triangles.push_back(triangle);
    }
    for (auto& triangle : mesh.triangles) {
      if (turned && random.bits() % 2 == 0) std::swap(triangle[0], triangle[1]);
    }
    ASSERT_FALSE(ContactMesh::build(mesh).ok());
    const RepairedMesh repaired = repair_mesh(mesh);
    EXPECT_EQ(count(repaired, Kind::kPartedEdge), 1u);
    const MeshFindings found = check_mesh(repaired.mesh);
    EXPECT_TRUE(found.touchable()) << turned;
    EXPECT_EQ(found.components, 2u);
    EXPECT_NEAR(found.volume, 16, 1e-9);
  }
}

}  // namespace
}  // namespace thimble::render
