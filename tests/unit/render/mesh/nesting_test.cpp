#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cstdint>
#include <vector>

#include "compact_mesh/packed_surface.h"
#include "mesh/repair/orient_mesh.h"
#include "mesh/smooth_normals.h"
#include "support/meshes/shapes.h"
#include "thimble/render/mesh/check_mesh.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

void append(const TriangleMesh& part, const Vector3d& shift, bool turned, TriangleMesh& mesh) {
  const auto first = static_cast<std::int32_t>(mesh.vertices.size());
  for (const Vector3d& p : part.vertices) mesh.vertices.push_back(p + shift);
  for (const auto& [a, b, c] : part.triangles) {
    mesh.triangles.push_back({first + a, first + (turned ? c : b), first + (turned ? b : c)});
  }
}

std::vector<bool> inside_out(const TriangleMesh& mesh) {
  return find_components(mesh, sorted_edge_uses(mesh)).inside_out;
}

// 500 nested boxes: a comparison of every pair of boxes with all their corners took 48 s.
TEST(Nesting, DistinguishesCavitiesInManyNestedBoxes) {
  TriangleMesh mesh;
  constexpr int kBoxes = 500;
  for (int i = 0; i < kBoxes; ++i) {
    // From the inside out, each correctly oriented: the outermost encloses matter.
    append(support::box(Vector3d::Constant(1 + 0.01 * i)), {0, 0, 0}, (kBoxes - 1 - i) % 2 == 1,
           mesh);
  }
  EXPECT_TRUE(check_mesh(mesh).touchable());
  // With all triangles reversed, all boxes are wrong.
  for (auto& triangle : mesh.triangles) std::swap(triangle[0], triangle[1]);
  for (const bool wrong : inside_out(mesh)) EXPECT_TRUE(wrong);
}

TEST(Nesting, DistinguishesCavitiesAmongBubblesAndFragments) {
  // A ball with bubbles, a fragment in every third one, and fragments next to the ball.
  TriangleMesh mesh;
  append(support::icosphere(4, 1), {0, 0, 0}, false, mesh);
  const TriangleMesh bubble = support::icosphere(2, 0.05), crumb = support::icosphere(1, 0.02);
  int bubbles = 0;
  for (int x = -4; x <= 4; ++x) {
    for (int y = -4; y <= 4; ++y) {
      for (int z = -4; z <= 4; ++z) {
        const Vector3d p = 0.15 * Vector3d(x, y, z);
        if (p.norm() > 0.85) continue;
        append(bubble, p, true, mesh);
        if (bubbles++ % 3 == 0) append(crumb, p, false, mesh);
      }
    }
  }
  for (int i = 0; i < 20; ++i) append(crumb, {2, 0.1 * i, 0}, false, mesh);
  ASSERT_GT(bubbles, 400);
  EXPECT_TRUE(check_mesh(mesh).touchable());
}

// A part in another part's box need not be inside it: a ray from a ball in a ring's hole leaves the
// ring as often as it enters.
TEST(Nesting, BallInARingsHoleIsNotInTheRing) {
  for (const bool in_the_tube : {false, true}) {
    TriangleMesh mesh = support::torus(1, 0.4, 48, 24);
    append(support::icosphere(2, 0.1), in_the_tube ? Vector3d(0, 1, 0) : Vector3d(0, 0, 0), false,
           mesh);
    EXPECT_EQ(inside_out(mesh), (std::vector<bool>{false, in_the_tube}));
  }
}

// A hub of 100,000 triangles once took quadratic time in the normals and in the packed triangles:
// minutes.
TEST(Nesting, PreparesAHubOfManyTriangles) {
  const TriangleMesh hub = support::needle(100'000, 0.05, 0.1);
  const auto mesh = ContactMesh::build(hub);
  ASSERT_TRUE(mesh.ok()) << mesh.error().message;
  const SmoothNormals normals(*mesh, kCreaseAngle, NormalWeights::kFitted);
  const auto packed = PackedSurface::build(hub, {});
  ASSERT_TRUE(packed.ok()) << packed.error().message;
  for (std::int32_t t = 0; t < mesh->triangle_count(); t += 997) {
    for (const Vector3d& n : normals.corners(t)) {
      EXPECT_NEAR(n.norm(), 1, 1e-9);
      EXPECT_GT(n.dot(mesh->cell(t).face.n), 0);
    }
  }
}

}  // namespace
}  // namespace thimble::render
