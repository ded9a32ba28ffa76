#include "search/baseline/linear_search.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "mesh/segment_crossing.h"
#include "support/meshes/reference_geometry.h"
#include "support/meshes/shapes.h"
#include "support/seed.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

// A mesh with its search, and the points of a test.
struct Scene {
  explicit Scene(const TriangleMesh& shape, std::uint64_t seed = 5)
      : mesh(shape),
        contact(ContactMesh::build(shape).value()),
        search(contact),
        random(support::seed_of(seed)) {}

  Vector3d point(double size) {
    std::uniform_real_distribution<double> uniform(-size, size);
    return {uniform(random), uniform(random), uniform(random)};
  }

  int net_entries(const Vector3d& from, const Vector3d& to) const {
    int net = 0;
    for (std::int32_t t = 0; t < contact.triangle_count(); ++t) {
      const Crossing way = crossing(from, to, contact.position(t, 0), contact.position(t, 1),
                                    contact.position(t, 2));
      net += (way == Crossing::kEnters) - (way == Crossing::kLeaves);
    }
    return net;
  }

  TriangleMesh mesh;
  ContactMesh contact;
  LinearSearch search;
  std::mt19937_64 random;
};

TEST(LinearSearch, EqualsBruteForceOnRandomSegments) {
  Scene scene(support::bumpy_sphere(2, 0.05, 0.3, 6));
  int entered = 0;
  for (int i = 0; i < 100000; ++i) {
    const Vector3d from = scene.point(0.08);
    const Vector3d to = i % 2 == 0 ? scene.point(0.08) : Vector3d(from + scene.point(0.01));
    Entry wanted;
    wanted.parameter = 2;
    for (std::size_t t = 0; t < scene.mesh.triangles.size(); ++t) {
      if (!(support::outward_normal(scene.mesh, t).dot(to - from) < 0)) continue;
      const auto hit =
          support::pierce(from, to, support::corner(scene.mesh, t, 0),
                          support::corner(scene.mesh, t, 1), support::corner(scene.mesh, t, 2));
      if (hit && *hit < wanted.parameter) wanted = {static_cast<std::int32_t>(t), *hit};
    }
    const Entry found = scene.search.first_entry(from, to);
    ASSERT_EQ(found.triangle, wanted.triangle) << "segment " << i;
    if (found.triangle >= 0) {
      ASSERT_NEAR(found.parameter, wanted.parameter, 1e-9);
      ++entered;
    }
  }
  EXPECT_GT(entered, 10000);
}

TEST(LinearSearch, EntersVerticesAndEdgesExactlyOnce) {
  Scene scene(support::icosphere(3, 0.05));
  std::vector<Vector3d> targets = scene.mesh.vertices;
  for (const auto& [a, b, c] : scene.mesh.triangles) {
    targets.push_back((scene.mesh.vertices[static_cast<std::size_t>(a)] +
                       scene.mesh.vertices[static_cast<std::size_t>(b)]) /
                      2);
  }
  for (const Vector3d& target : targets) {
    for (const double reach : {2.0, 1.0}) {
      // The second segment ends on the target itself: either it or the next one must enter.
      const Vector3d begin = 2 * target;
      const Vector3d end = begin - reach * target;
      EXPECT_EQ(scene.net_entries(begin, end) + scene.net_entries(end, 0.1 * target), 1);
      if (reach == 2.0) {
        EXPECT_GE(scene.search.first_entry(begin, end).triangle, 0);
      }
    }
  }
}

TEST(LinearSearch, SegmentsThatMeetOnTheSurfaceMissNothing) {
  // Coordinates on a coarse grid: nearly every point lies exactly on planes, edges or corners.
  Scene scene(support::plate(1, 0.5, 4));
  std::uniform_int_distribution<int> grid(-5, 5);
  const auto any = [&]() -> Vector3d {
    return Vector3d(grid(scene.random), grid(scene.random), grid(scene.random)) / 8;
  };
  Vector3d before = any();
  int changes = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vector3d now = any();
    const int change =
        static_cast<int>(scene.search.inside(now)) - static_cast<int>(scene.search.inside(before));
    ASSERT_EQ(scene.net_entries(before, now), change) << "step " << i;
    if (change > 0) {
      ASSERT_GE(scene.search.first_entry(before, now).triangle, 0);
    }
    changes += change != 0;
    before = now;
  }
  EXPECT_GT(changes, 1000);
}

TEST(LinearSearch, InsideMatchesTheWindingNumber) {
  Scene scene(support::torus(0.05, 0.02, 30, 20));
  int inside = 0;
  for (int i = 0; i < 5000; ++i) {
    const Vector3d p = scene.point(0.08);
    ASSERT_EQ(scene.search.inside(p), support::is_inside(scene.mesh, p));
    inside += scene.search.inside(p);
  }
  EXPECT_GT(inside, 300);
}

TEST(LinearSearch, FindsNoEntryForNaNAndHugeNumbers) {
  Scene scene(support::icosphere(1, 1));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, infinity, -infinity, 1e300}) {
    EXPECT_EQ(scene.search.first_entry({bad, 0, 0}, {0, 0, 0}).triangle, -1);
    EXPECT_EQ(scene.search.first_entry({2, 0, 0}, {0, bad, 0}).triangle, -1);
    EXPECT_FALSE(scene.search.inside({0, 0, bad}));
  }
  EXPECT_EQ(scene.search.first_entry({2, 0, 0}, {2, 0, 0}).triangle, -1);
  EXPECT_GE(scene.search.first_entry({1e14, 0.01, 0.02}, {0, 0.01, 0.02}).triangle, 0);
}

}  // namespace
}  // namespace thimble::render
