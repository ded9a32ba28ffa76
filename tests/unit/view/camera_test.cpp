#include "view/camera.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/meshes/shapes.h"
#include "support/random.h"

namespace thimble::view {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

Camera any_camera(support::Random& random) {
  Camera camera;
  camera.p_WTarget = random.in_box(0.2);
  camera.yaw = random.uniform(-3, 3);
  camera.pitch = random.uniform(-1.4, 1.4);
  camera.distance = random.uniform(0.05, 2);
  return camera;
}

TEST(Camera, ProjectionAndRaysAgree) {
  support::Random random(3);
  for (int i = 0; i < 1000; ++i) {
    const Camera camera = any_camera(random);
    const double x = random.uniform(0, 800);
    const double y = random.uniform(0, 500);
    const Vector3d p = camera.p_WEye() + random.uniform(0.1, 2) * camera.ray(x, y, 800, 500);
    EXPECT_LT((camera.pixel(p, 800, 500) - Vector2d(x, y)).norm(), 1e-6);
    // The matrices give the same result.
    const Eigen::Vector4f clip =
        camera.projection(800.0 / 500) * camera.view() * p.cast<float>().homogeneous();
    EXPECT_NEAR((clip.x() / clip.w() + 1) * 400, x, 0.05);
    EXPECT_NEAR((1 - clip.y() / clip.w()) * 250, y, 0.05);
  }
}

TEST(Camera, FramesAllThatMustBeSeenFromAnySide) {
  support::Random random(4);
  for (int i = 0; i < 100; ++i) {
    DrawnScene scene;
    render::TriangleMesh mesh =
        support::box({random.uniform(0.01, 0.1), random.uniform(0.01, 0.1), 0.03});
    const Vector3d away = random.in_box(0.1);
    for (Vector3d& vertex : mesh.vertices) vertex += away;
    scene.objects.push_back({.name = "box", .mesh = mesh});
    DrawnMoment moment;
    const Vector3d tip = away + random.in_box(0.08);
    moment.tick.p_WT = moment.tick.p_WP = {tip.x(), tip.y(), tip.z()};
    moment.tick.n_W = {std::cos(0.1 * i), std::sin(0.1 * i), 0};
    moment.tick.in_contact = i % 2 == 0;
    moment.tick.f_sent_W = {random.uniform(-3, 3), 0, 2};
    const double aspect = random.uniform(0.5, 2.5);
    const Camera camera = frame(scene, moment, aspect);
    double nearest_rim = 1e9;
    for (const Vector3d& point : framed_points(scene, moment)) {
      const Vector2d at = camera.pixel(point, 500 * aspect, 500);
      for (const double inside : {at.x(), at.y(), 500 * aspect - at.x(), 500 - at.y()}) {
        EXPECT_GT(inside, 0);
        nearest_rim = std::min(nearest_rim, inside);
      }
    }
    EXPECT_LT(nearest_rim, 0.2 * 500);  // and not from a large distance
  }
}

TEST(Camera, NeverTurnsOver) {
  Camera camera;
  for (int i = 0; i < 100; ++i) camera.orbit(0.3, 0.2);
  EXPECT_GT(camera.up().z(), 0);
  for (int i = 0; i < 100; ++i) camera.orbit(0.3, -0.2);
  EXPECT_GT(camera.up().z(), 0);
  for (int i = 0; i < 500; ++i) camera.zoom(2);
  EXPECT_GE(camera.distance, 1e-3);
}

}  // namespace
}  // namespace thimble::view
