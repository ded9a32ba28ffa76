#include "view/camera.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/meshes/shapes.h"
#include "support/random.h"
#include "unit/view/any_camera.h"

namespace thimble::view {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

TEST(Camera, ProjectionAndRaysAgree) {
  support::Random random(3);
  for (int i = 0; i < 1000; ++i) {
    const Camera camera = any_camera(random, 0.2, 2);
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

TEST(Camera, ShowsTwoArmsNextToEachOther) {
  for (int i = 0; i < 24; ++i) {
    const double way = 0.3 * i;
    DrawnScene scene;
    scene.objects.push_back({.name = "beam", .mesh = support::box({0.05, 0.05, 0.01})});
    DrawnMoment moment;
    moment.tick.p_WT = {0.05 * std::cos(way), 0.05 * std::sin(way), 0.01};
    moment.tick.in_contact = true;
    moment.tick.n_W = {std::cos(way), std::sin(way), 0};  // along the line of the tips
    DrawnArm& other = moment.others.emplace_back();
    other.tick.p_WT = {-0.05 * std::cos(way), -0.05 * std::sin(way), 0.02};
    const Camera camera = frame(scene, moment, 1.5);
    const Vector3d line(std::cos(way), std::sin(way), 0);
    EXPECT_GT(std::abs(line.dot(camera.right())), 0.9) << way;
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
