#include "search/tree_search.h"

#include <gtest/gtest.h>

#include <limits>

#include "mesh/file/weld_mesh.h"
#include "search/baseline/linear_search.h"
#include "support/long_form.h"
#include "support/meshes/bench_meshes.h"
#include "support/meshes/reference_geometry.h"
#include "support/meshes/shapes.h"
#include "support/random.h"
#include "thimble/render/mesh/mesh_file.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

int scaled(int full, int brief) {
  return support::long_form() ? full : brief;
}

// Returns the rounded positions of a packed surface as a mesh, in the order of its packed
// triangles.
TriangleMesh mesh_of(const PackedSurface& surface) {
  TriangleMesh mesh;
  for (std::int32_t t = 0; t < surface.triangle_count(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) mesh.vertices.push_back(surface.position(t, k));
    mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  return weld_mesh(mesh);
}

// The tree, and the paper's search over the same positions.
struct Scene {
  explicit Scene(const TriangleMesh& shape)
      : surface(PackedSurface::build(shape).value()),
        tree(surface),
        mesh(mesh_of(surface)),
        contact(ContactMesh::build(mesh).value()),
        linear(contact) {}

  void expect_same(const Vector3d& from, const Vector3d& to) {
    const Entry wanted = linear.first_entry(from, to);
    const Entry found = tree.first_entry(from, to);
    ASSERT_EQ(found.triangle, wanted.triangle)
        << from.transpose() << " to " << to.transpose() << " at " << found.parameter << " and "
        << wanted.parameter;
    if (found.triangle < 0) return;
    ASSERT_NEAR(found.parameter, wanted.parameter, 1e-9);
    ++entries;
  }

  PackedSurface surface;
  TreeSearch<PackedSurface> tree;
  TriangleMesh mesh;
  ContactMesh contact;
  LinearSearch linear;
  int entries = 0;
};

TEST(TreeSearch, MatchesLinearSearchOnRandomSegments) {
  for (const TriangleMesh& shape :
       {support::bumpy_sphere(3, 0.05, 0.3, 6), support::torus(0.035, 0.015, 40, 20),
        support::plate(0.1, 0.01, 6), support::needle(64, 0.08, 0.01),
        support::wedge(0.09, 0.1, 0.05)}) {
    Scene scene(shape);
    support::Random random(11);
    for (int i = 0; i < scaled(200000, 20000); ++i) {
      const Vector3d from = random.in_box(0.08);
      const Vector3d to = i % 2 == 0 ? random.in_box(0.08) : Vector3d(from + random.in_box(0.01));
      scene.expect_same(from, to);
      if (i % 10 == 0) {
        ASSERT_EQ(scene.tree.inside(from), scene.linear.inside(from));
      }
    }
    EXPECT_GT(scene.entries, 500);
  }
}

TEST(TreeSearch, MatchesLinearSearchAtVerticesAndEdges) {
  Scene scene(support::icosphere(3, 0.05));
  support::Random random(12);
  for (const Vector3d& v : scene.mesh.vertices) {
    scene.expect_same(2 * v, -v);
    scene.expect_same(2 * v, v);
    scene.expect_same(v, 0.1 * v);
    scene.expect_same(v + random.in_box(0.02), v);
    ASSERT_EQ(scene.tree.inside(v), scene.linear.inside(v));
  }
  for (const auto& [a, b, c] : scene.mesh.triangles) {
    const Vector3d middle = (scene.mesh.vertices[static_cast<std::size_t>(a)] +
                             scene.mesh.vertices[static_cast<std::size_t>(b)]) /
                            2;
    scene.expect_same(2 * middle, 0.5 * middle);
    scene.expect_same(middle, 0.5 * middle);
  }
  EXPECT_GT(scene.entries, 3000);
}

TEST(TreeSearch, SegmentsThatMeetOnTheSurfaceMissNothing) {
  // Coordinates on a coarse grid: nearly every point lies exactly on planes, edges or corners.
  Scene scene(support::plate(1, 0.5, 4));
  support::Random random(13);
  const auto grid = [&random] { return static_cast<double>(random.bits() % 11) / 8 - 0.625; };
  Vector3d before(grid(), grid(), grid());
  int changes = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vector3d now(grid(), grid(), grid());
    scene.expect_same(before, now);
    ASSERT_EQ(scene.tree.inside(now), scene.linear.inside(now));
    if (scene.tree.inside(now) && !scene.tree.inside(before)) {
      ASSERT_GE(scene.tree.first_entry(before, now).triangle, 0);
      ++changes;
    }
    before = now;
  }
  EXPECT_GT(changes, 500);
}

TEST(TreeSearch, IsIndependentOfScaleAndOrigin) {
  for (const double scale : {1e-6, 1.0, 1e3}) {
    for (const double offset : {0.0, 1e4 * scale}) {
      Scene scene(placed(support::bumpy_sphere(2, 0.05, 0.3, 6), scale, Eigen::Matrix3d::Identity(),
                         Vector3d(offset, -offset, offset)));
      support::Random random(14);
      const Vector3d middle(offset, -offset, offset);
      for (int i = 0; i < 5000; ++i) {
        const Vector3d from = middle + scale * random.in_box(0.08);
        scene.expect_same(from, middle + scale * random.in_box(0.08));
      }
      EXPECT_GT(scene.entries, 500);
    }
  }
}

TEST(TreeSearch, FindsTheNearestPointLikeBruteForce) {
  for (const TriangleMesh& shape :
       {support::bumpy_sphere(3, 0.05, 0.3, 6), support::box({0.03, 0.02, 0.01})}) {
    Scene scene(shape);
    support::Random random(15);
    for (int i = 0; i < 1000; ++i) {
      const Vector3d p = random.in_box(0.1);
      const auto wanted = support::nearest_on_mesh(scene.mesh, p);
      const SurfacePoint found = scene.tree.closest(p, 1);
      ASSERT_GE(found.triangle, 0);
      ASSERT_NEAR(found.distance, wanted.distance, 1e-10);
      ASSERT_NEAR((found.p_W - p).norm(), wanted.distance, 1e-10);
      EXPECT_EQ(scene.tree.closest(p, 0.999 * wanted.distance).triangle, -1);
      EXPECT_EQ(scene.tree.closest(p, 1.001 * wanted.distance).triangle, found.triangle);
    }
  }
}

// More boxes on a level than are queried in parallel: near the middle of a ball all are equally
// near, and a chord through the dense fan of a needle's tip, or along its side, meets very many.
TEST(TreeSearch, GivesTheSameAnswersWhereVeryManyBoxesAreMet) {
  support::Random random(12);
  Scene ball(support::icosphere(4, 0.05));
  const LinearSearchOver<PackedSurface> brute(ball.surface);
  for (int i = 0; i < 60; ++i) {
    const Vector3d p = random.in_box(i < 20 ? 0 : i < 40 ? 1e-6 : 1e-3);
    const SurfacePoint found = ball.tree.closest(p, 1), wanted = brute.closest(p, 1);
    ASSERT_EQ(found.triangle, wanted.triangle);
    ASSERT_EQ(found.distance, wanted.distance);
    ASSERT_EQ(found.p_W, wanted.p_W);
  }
  Scene needle(support::needle(1024, 0.08, 0.01));
  const LinearSearchOver<PackedSurface> all(needle.surface);
  for (int i = 0; i < 200; ++i) {
    const Vector3d from = random.in_box(0.09);
    const Vector3d to = i % 2 == 0 ? Vector3d(-from + random.in_box(1e-3)) : random.in_box(0.01);
    needle.expect_same(from, to);
    const Vector3d p = random.in_box(0.08);
    ASSERT_EQ(needle.tree.inside(p), all.inside(p));
  }
  EXPECT_GT(needle.entries, 5);
}

TEST(TreeSearch, FindsNothingForNaNAndHugeNumbers) {
  Scene scene(support::icosphere(1, 1));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, infinity, -infinity, 1e300}) {
    EXPECT_EQ(scene.tree.first_entry({bad, 0, 0}, {0, 0, 0}).triangle, -1);
    EXPECT_EQ(scene.tree.first_entry({2, 0, 0}, {0, bad, 0}).triangle, -1);
    EXPECT_FALSE(scene.tree.inside({0, 0, bad}));
    EXPECT_EQ(scene.tree.closest({0, 0, bad}, 1).triangle, -1);
  }
  EXPECT_EQ(scene.tree.closest({0, 0, 0}, nan).triangle, -1);
  EXPECT_GE(scene.tree.closest({0, 0, 0}, infinity).triangle, 0);
  EXPECT_GE(scene.tree.first_entry({1e14, 0.01, 0.02}, {0, 0.01, 0.02}).triangle, 0);
}

}  // namespace
}  // namespace thimble::render
