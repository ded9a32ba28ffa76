#include "view/gl/dent_surface.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <memory>
#include <set>

#include "body/dent/bendable_polygon.h"
#include "mesh/surface_weights.h"
#include "support/meshes/shapes.h"
#include "support/random.h"

namespace thimble::view {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

/// A dent in a mesh, and how it is drawn.
struct Fixture {
  explicit Fixture(const render::TriangleMesh& given)
      : mesh(given),
        drawn(crease(mesh, 0.87)),
        surface(mesh, drawn),
        dent(render::BendablePolygon::build(std::make_shared<const render::ContactMesh>(
                                                render::ContactMesh::build(mesh).value()),
                                            {})
                 .value()) {}

  void press(std::int32_t triangle, const Vector3d& w, double depth) {
    const auto& contact = dent.mesh();
    dent.touch(triangle, w,
               render::point_at(contact, triangle, w) - depth * contact.cell(triangle).face.n);
    dent.draw(patch);
    surface.set(patch);
  }

  render::TriangleMesh mesh;
  CreasedMesh drawn;
  DentSurface surface;
  render::BendablePolygon dent;
  render::BodyPatch patch;
};

Vector3d any_weights(support::Random& random) {
  const Vector3d w{random.uniform(0.02, 1), random.uniform(0.02, 1), random.uniform(0.02, 1)};
  return w / w.sum();
}

// Returns the mesh's own normal at the origin of a bent corner, interpolated as in Phong shading.
Vector3f whole_normal(const DentVertex& v) {
  return v.weights[0] * v.n_a + v.weights[1] * v.n_b + v.weights[2] * v.n_c;
}

TEST(DentSurface, EqualsWholeTrianglesAtFirstTouch) {
  support::Random random(1);
  for (const auto& mesh : {support::icosphere(2, 0.04), support::box({0.04, 0.05, 0.06})}) {
    Fixture f(mesh);
    for (int i = 0; i < 200; ++i) {
      const auto triangle = static_cast<std::int32_t>(random.bits() % mesh.triangles.size());
      f.press(triangle, any_weights(random), 1e-9);
      ASSERT_GE(f.surface.vertices().size(), 3U * 6);
      for (const DentVertex& v : f.surface.vertices()) {
        EXPECT_LT((v.n - whole_normal(v)).norm(), 2e-6F);
        const Vector3f whole = v.weights[0] * v.p_a + v.weights[1] * v.p_b + v.weights[2] * v.p_c;
        EXPECT_LT((v.p - whole).norm(), 1e-7F);
        EXPECT_NEAR(v.weights.sum(), 1, 1e-6);
      }
    }
  }
}

TEST(DentSurface, HidesReplacedTrianglesOnceAndInOrder) {
  support::Random random(2);
  Fixture f(support::icosphere(3, 0.04));
  for (int i = 0; i < 50; ++i) {
    f.press(static_cast<std::int32_t>(random.bits() % f.mesh.triangles.size()), any_weights(random),
            0.004);
    const auto& hidden = f.surface.hidden();
    std::set<std::uint32_t> sources;
    for (std::size_t t = 0; t < f.patch.triangle_count; ++t) {
      sources.insert(static_cast<std::uint32_t>(f.patch.source[t]));
    }
    EXPECT_TRUE(std::equal(hidden.begin(), hidden.end(), sources.begin(), sources.end()));
  }
}

TEST(DentSurface, NormalsTurnWithTheSurfaceAsItBends) {
  Fixture f(support::icosphere(3, 0.04));
  const Vector3d middle = Vector3d::Constant(1.0 / 3);
  for (int i = 0; i < 100; ++i) f.press(0, middle, 0.004);
  float max = 0;
  for (const DentVertex& v : f.surface.vertices()) {
    EXPECT_TRUE(v.n.allFinite());
    max = std::max(max, (v.n.normalized() - whole_normal(v).normalized()).norm());
  }
  EXPECT_GT(max, 0.05F);
}

TEST(DentSurface, IgnoresPatchWithInvalidIndices) {
  Fixture f(support::icosphere(2, 0.04));
  f.press(3, Vector3d::Constant(1.0 / 3), 0.002);
  const render::BodyPatch good = f.patch;
  const auto refused = [&](const render::BodyPatch& patch) {
    f.surface.set(patch);
    return f.surface.vertices().empty() && f.surface.hidden().empty();
  };
  EXPECT_FALSE(refused(good));
  auto bad = std::make_unique<render::BodyPatch>(good);
  bad->source[0] = static_cast<std::int32_t>(f.mesh.triangles.size());
  EXPECT_TRUE(refused(*bad));
  *bad = good;
  bad->source[0] = -1;
  EXPECT_TRUE(refused(*bad));
  *bad = good;
  bad->triangles[0][1] = good.point_count;
  EXPECT_TRUE(refused(*bad));
  *bad = good;
  bad->points[0].vertex = static_cast<std::int32_t>(f.mesh.vertices.size());
  EXPECT_TRUE(refused(*bad));
  *bad = good;
  bad->triangle_count = 0xffff;
  EXPECT_TRUE(refused(*bad));
}

}  // namespace
}  // namespace thimble::view
