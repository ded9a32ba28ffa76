#include "compact_mesh/packed_surface.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <map>

#include "search/tree_search.h"
#include "support/meshes/bench_meshes.h"
#include "support/meshes/reference_geometry.h"
#include "support/meshes/shapes.h"
#include "support/random.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

std::size_t index(std::int32_t i) {
  return static_cast<std::size_t>(i);
}

TEST(PackedSurface, PacksNormalsToBetterThanAHundredMicroradian) {
  support::Random random(3);
  for (int i = 0; i < 100000; ++i) {
    const Vector3d n = random.direction();
    ASSERT_LT((unpack_normal(pack_normal(n)) - n).norm(), 7e-5) << n.transpose();
  }
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_EQ(unpack_normal(pack_normal(Vector3d::Unit(axis))), Vector3d::Unit(axis));
    EXPECT_EQ(unpack_normal(pack_normal(-Vector3d::Unit(axis))), -Vector3d::Unit(axis));
  }
}

TEST(PackedSurface, HoldsEveryTriangleOnceWithItsCornersInOrder) {
  const TriangleMesh mesh = support::torus(0.05, 0.02, 40, 30);
  const PackedSurface surface = PackedSurface::build(mesh).value();
  std::vector<int> seen(mesh.triangles.size());
  for (std::int32_t t = 0; t < surface.triangle_count(); ++t) {
    const std::size_t source = index(surface.source(t));
    ++seen[source];
    for (std::size_t k = 0; k < 3; ++k) {
      ASSERT_LT((surface.position(t, k) - support::corner(mesh, source, k)).norm(), 1e-10);
    }
  }
  EXPECT_EQ(seen, std::vector<int>(mesh.triangles.size(), 1));
}

TEST(PackedSurface, NeighboursShareEdgesAndSmoothNormals) {
  const TriangleMesh mesh = support::bumpy_sphere(4, 0.05, 0.3, 6);
  const PackedSurface surface = PackedSurface::build(mesh).value();
  int creases = 0;
  for (std::int32_t t = 0; t < surface.triangle_count(); ++t) {
    const PackedTriangle& mine = surface.triangle(t);
    for (std::size_t k = 0; k < 3; ++k) {
      const PackedTriangle& theirs = surface.triangle(mine.neighbours[k]);
      int shared = 0;
      for (std::size_t j = 0; j < 3; ++j) {
        if (theirs.neighbours[j] != t) continue;
        ++shared;
        ASSERT_EQ(theirs.corner(j), mine.corner((k + 1) % 3));
        ASSERT_EQ(theirs.corner((j + 1) % 3), mine.corner(k));
        ASSERT_EQ(theirs.crease(j), mine.crease(k));
        creases += mine.crease(k);
        if (mine.crease(k)) continue;
        ASSERT_EQ(theirs.normals[j], mine.normals[(k + 1) % 3]);
        ASSERT_EQ(theirs.normals[(j + 1) % 3], mine.normals[k]);
      }
      ASSERT_EQ(shared, 1);
    }
  }
  EXPECT_LT(creases, 10);  // in the steepest dents
}

TEST(PackedSurface, CreasesSplitNormals) {
  const PackedSurface surface = PackedSurface::build(support::box({0.03, 0.02, 0.01})).value();
  for (std::int32_t t = 0; t < surface.triangle_count(); ++t) {
    const PackedTriangle& r = surface.triangle(t);
    const Vector3d face = (r.corner(1) - r.corner(0)).cross(r.corner(2) - r.corner(0)).normalized();
    int creases = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      creases += r.crease(k);
      EXPECT_EQ(unpack_normal(r.normals[k]), face);
    }
    EXPECT_EQ(creases, 2);  // not the diagonal
  }
}

TEST(PackedSurface, RecordTakes64BytesAnd96WithTheTree) {
  static_assert(sizeof(PackedTriangle) == 64);
  const TriangleMesh mesh = support::bench_ball({}, 100000);
  const PackedSurface surface = PackedSurface::build(mesh).value();
  const TreeSearch<PackedSurface> tree(surface);
  const double per_triangle = static_cast<double>(surface.bytes() + tree.bytes()) /
                              static_cast<double>(mesh.triangles.size());
  EXPECT_LE(per_triangle, 96);
  EXPECT_GE(per_triangle, 68);
}

TEST(PackedSurface, RefusesOpenSurfacesWithThePlace) {
  TriangleMesh open = support::icosphere(1, 1);
  open.triangles.pop_back();
  TriangleMesh flipped = support::icosphere(1, 1);
  std::swap(flipped.triangles[7][0], flipped.triangles[7][1]);
  TriangleMesh doubled = support::icosphere(1, 1);
  doubled.triangles.push_back(doubled.triangles[5]);
  for (const TriangleMesh& mesh : {open, flipped, doubled}) {
    const auto refused = PackedSurface::build(mesh);
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find("lacks a unique neighbour"), std::string::npos);
  }
  TriangleMesh flat = support::box({1, 1, 1});
  for (Vector3d& v : flat.vertices) v.z() = v.y() = 0;
  TriangleMesh nowhere = support::box({1, 1, 1});
  nowhere.vertices[3].y() = std::numeric_limits<double>::quiet_NaN();
  TriangleMesh missing = support::box({1, 1, 1});
  missing.triangles[2][1] = 8;
  TriangleMesh point = support::box({0, 0, 0});
  for (const TriangleMesh& mesh : {flat, nowhere, missing, point, TriangleMesh{}}) {
    EXPECT_FALSE(PackedSurface::build(mesh));
  }
}

}  // namespace
}  // namespace thimble::render
