// Shapes that collide, as surfaces for drawing.

#include "collision/collider_surface.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "collision/collide_objects.h"
#include "support/meshes/shapes.h"
#include "thimble/render/build_primitive_touch.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

/// Volume of a closed surface, m^3; positive if its triangles are counter-clockwise from outside.
double volume(const TriangleMesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles) {
    const auto at = [&](std::size_t k) { return mesh.vertices[static_cast<std::size_t>(t[k])]; };
    sum += at(0).dot(at(1).cross(at(2))) / 6;
  }
  return sum;
}

double volume_of(ColliderForm form, const Vector3d& size) {
  Collider shape;
  shape.form = form;
  shape.size = size;
  ColliderSet set;
  set.shapes.push_back(shape);
  return volume(collider_surface(set, {}));
}

constexpr double kPi = std::numbers::pi;
constexpr double kRounding = 2e-5;  // m: Bullet rounds the corners of a hull to 1e-4 of its box

TEST(ColliderSurface, ABoxIsExact) {
  EXPECT_NEAR(volume_of(ColliderForm::kBox, {0.01, 0.02, 0.03}), 8 * 6e-6, 1e-12);
}

// Inscribed polyhedra of 24 sides are up to 3 % smaller than round shapes.
TEST(ColliderSurface, RoundShapesAreInscribed) {
  const double r = 0.02, h = 0.03;
  const std::vector<std::pair<double, double>> drawn_and_exact = {
      {volume_of(ColliderForm::kSphere, {r, r, r}), 4 * kPi / 3 * r * r * r},
      {volume_of(ColliderForm::kCylinder, {r, r, h}), 2 * kPi * r * r * h},
      {volume_of(ColliderForm::kCone, {r, r, h}), 2 * kPi / 3 * r * r * h},
      {volume_of(ColliderForm::kCapsule, {r, r, h}),
       2 * kPi * r * r * h + 4 * kPi / 3 * r * r * r}};
  for (const auto& [drawn, exact] : drawn_and_exact) {
    EXPECT_LT(drawn, exact);
    EXPECT_GT(drawn, 0.97 * exact);
  }
}

TEST(ColliderSurface, AHullEnclosesTheMesh) {
  const TriangleMesh ring = support::torus(0.03, 0.01, 32, 16);
  const auto set = collider_of({&ring, nullptr}, {.shape = CollisionShape::kHull}, {});
  ASSERT_TRUE(set) << set.error().message;
  const TriangleMesh hull = collider_surface(*set, {});
  EXPECT_GT(volume(hull), 1.3 * volume(ring)) << "its hole is filled";
  for (const auto& t : hull.triangles) {
    const auto at = [&](std::size_t k) { return hull.vertices[static_cast<std::size_t>(t[k])]; };
    const Vector3d n = (at(1) - at(0)).cross(at(2) - at(0)).normalized();
    for (const Vector3d& p : ring.vertices) ASSERT_LT(n.dot(p - at(0)), kRounding);
  }
}

TEST(ColliderSurface, PiecesLeaveTheHole) {
  const TriangleMesh ring = support::torus(0.03, 0.01, 32, 16);
  const auto set = collider_of({&ring, nullptr}, {.shape = CollisionShape::kPieces}, {});
  ASSERT_TRUE(set) << set.error().message;
  ASSERT_GT(set->shapes.size(), 3u);
  EXPECT_LT(volume(collider_surface(*set, {})), 1.3 * volume(ring));
}

TEST(ColliderSurface, ShapesOfABodyAreAtItsFirstPlace) {
  TriangleMesh block = support::box({0.03, 0.02, 0.01});
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(0.4, Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  for (Vector3d& p : block.vertices) p = Vector3d(0.1, -0.2, 0.3) + R * p;
  const PlaceOfBody place{R, {0.1, -0.2, 0.3}};
  for (const CollisionShape kind : {CollisionShape::kHull, CollisionShape::kBox}) {
    const auto set = collider_of({&block, nullptr}, {.shape = kind}, place);
    ASSERT_TRUE(set) << set.error().message;
    const TriangleMesh drawn = collider_surface(*set, place);
    ASSERT_EQ(drawn.vertices.size(), 8u);
    for (const Vector3d& p : block.vertices) {
      double nearest = 1;
      for (const Vector3d& q : drawn.vertices) nearest = std::min(nearest, (p - q).norm());
      EXPECT_LT(nearest, kRounding);
    }
  }
}

/// Returns the surfaces of a table, a ring, a ball and an object that meets nothing, the last three
/// of which move.
std::shared_ptr<const CollisionSurfaces> surfaces_of_scene() {
  static const TriangleMesh ring = support::torus(0.03, 0.01, 32, 16);
  static const TriangleMesh round = support::icosphere(2, 0.02);
  static const Primitive ball = Sphere{{0, 0, 0}, 0.02};
  static const Primitive table = HalfSpace{};
  std::vector<CollidingObject> objects(4);
  objects[0].solid.shape_W = &table;
  objects[1].solid.mesh_W = &ring;
  objects[2].solid = {&round, &ball};
  objects[3].solid.mesh_W = &ring;
  objects[3].collision.shape = CollisionShape::kNone;
  MotionChoice motion;
  motion.kind = MotionKind::kRigid;
  for (std::size_t i = 1; i < 4; ++i) {
    objects[i].motion = motion;
    objects[i].surfaces.push_back(build_primitive_touch(ball, SurfaceChoice{}));
  }
  auto met = collide_objects(std::move(objects), {}, {}, 1);
  EXPECT_TRUE(met) << (met ? "" : met.error().message);
  return met ? met->surfaces : nullptr;
}

TEST(CollisionSurfaces, ObjectsTouchedAsTheyCollideHaveNoOther) {
  const auto surfaces = surfaces_of_scene();
  ASSERT_TRUE(surfaces);
  EXPECT_FALSE(surfaces->surface_W(0)) << "the table";
  EXPECT_FALSE(surfaces->surface_W(2)) << "the ball";
}

TEST(CollisionSurfaces, AMovingMeshHasItsHull) {
  const auto surfaces = surfaces_of_scene();
  ASSERT_TRUE(surfaces);
  const auto hull = surfaces->surface_W(1);
  ASSERT_TRUE(hull);
  EXPECT_GT(volume(*hull), 1.3 * volume(support::torus(0.03, 0.01, 32, 16)));
}

TEST(CollisionSurfaces, AnObjectThatMeetsNothingHasNoTriangles) {
  const auto surfaces = surfaces_of_scene();
  ASSERT_TRUE(surfaces);
  const auto none = surfaces->surface_W(3);
  ASSERT_TRUE(none);
  EXPECT_TRUE(none->triangles.empty());
}

}  // namespace
}  // namespace thimble::render
