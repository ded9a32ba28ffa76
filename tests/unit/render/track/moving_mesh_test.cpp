#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <optional>
#include <vector>

#include "mesh/contact_mesh.h"
#include "search/baseline/linear_search.h"
#include "support/meshes/reference_geometry.h"
#include "support/meshes/shapes.h"
#include "support/random.h"
#include "track/surface_tracker.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

constexpr double kRadius = 0.03;  // m

void expect_equal(const Plane& a, const Plane& b) {
  EXPECT_EQ(a.n, b.n);
  EXPECT_EQ(a.d, b.d);
}

TEST(MovingMesh, HasThePlanesOfANewMesh) {
  TriangleMesh shape = support::bumpy_sphere(3, kRadius, 0.3, 6);
  ContactMesh moved = ContactMesh::build(shape).value();
  support::Random random(3);
  for (std::size_t v = 0; v < shape.vertices.size(); ++v) {
    const Vector3d p = shape.vertices[v] * random.uniform(0.97, 1);
    // The box is unchanged, and with it the origin of the planes.
    if ((shape.vertices[v].array() <= moved.box_min().array()).any() ||
        (shape.vertices[v].array() >= moved.box_max().array()).any()) {
      continue;
    }
    shape.vertices[v] = p;
    moved.move_vertex(static_cast<std::int32_t>(v), p);
  }
  const ContactMesh fresh = ContactMesh::build(shape).value();
  ASSERT_EQ(fresh.origin(), moved.origin());
  for (std::int32_t t = 0; t < fresh.triangle_count(); ++t) {
    expect_equal(moved.cell(t).face, fresh.cell(t).face);
    for (std::size_t k = 0; k < 3; ++k)
      expect_equal(moved.edge_planes(t)[k], fresh.edge_planes(t)[k]);
  }
}

// Returns the triangle that is crossed by the line from the ball's centre to a point.
std::int32_t triangle_over(const ContactMesh& mesh, const Vector3d& centre, const Vector3d& p) {
  for (std::int32_t t = 0; t < mesh.triangle_count(); ++t) {
    double least = INFINITY;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3d side =
          (mesh.position(t, k) - centre).cross(mesh.position(t, (k + 1) % 3) - centre);
      least = std::min(least, side.dot(p - centre));
    }
    if (least >= 0) return t;
  }
  return -1;
}

void move_ball(ContactMesh& mesh, const TriangleMesh& unit_ball, const Vector3d& centre,
               double radius) {
  for (std::size_t v = 0; v < unit_ball.vertices.size(); ++v) {
    mesh.move_vertex(static_cast<std::int32_t>(v), centre + radius * unit_ball.vertices[v]);
  }
}

TEST(MovingMesh, GrowingMovingMeshIsFollowedByARestingTip) {
  // A ball that grows and shrinks by a tenth and moves past the tip at up to 0.3 m/s; the tip does
  // not move, except to stay 1 mm deep. Relative to the ball it slides over many triangles.
  const TriangleMesh unit_ball = support::icosphere(3, 1);
  TriangleMesh shape = unit_ball;
  for (Vector3d& v : shape.vertices) v *= kRadius;
  ContactMesh mesh = ContactMesh::build(shape).value();
  const Vector3d tip_way(0.3, -0.2, 1);
  int hops = 0;
  std::int32_t active = triangle_over(mesh, Vector3d::Zero(), tip_way);
  ASSERT_GE(active, 0);
  std::optional<LinearSearch> search(mesh);
  SurfaceTracker tracker(mesh, *search);
  tracker.start(active);
  for (int tick = 0; tick < 3000; ++tick) {
    const double time = 0.001 * tick;
    const double radius = kRadius * (1 + 0.1 * std::sin(20 * time));
    const Vector3d centre(0.015 * std::sin(11 * time), 0.012 * std::sin(17 * time), 0);
    move_ball(mesh, unit_ball, centre, radius);
    // The search must have the new positions as well; SurfaceTracker uses it in case of doubt.
    search.emplace(mesh);
    const Vector3d way = (0.03 * tip_way.normalized() - centre).normalized();
    const Vector3d p = centre + (radius - 0.001) * way;
    const TrackerStep step = tracker.follow(p);
    ASSERT_TRUE(step.touching) << tick;
    active = tracker.active();
    hops += step.hops;
    // All edge planes of a ball pass through its centre: the cell is the one seen from the centre.
    double least = INFINITY;
    for (const Plane& plane : mesh.edge_planes(active)) {
      least = std::min(least, plane.distance(p - mesh.origin()));
    }
    ASSERT_GE(least, -1e-12) << tick;
    ASSERT_NEAR(step.depth, 0.001, 0.0006) << tick;  // the sagitta of these triangles
    if (tick % 50 == 0) {
      EXPECT_EQ(active, triangle_over(mesh, centre, p)) << tick;
    }
  }
  EXPECT_GT(hops, 100);
}

}  // namespace
}  // namespace thimble::render
