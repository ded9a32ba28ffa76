#include <gtest/gtest.h>

#include <memory>

#include "gl_or_skip.h"
#include "support/meshes/shapes.h"
#include "view/scene_painter.h"

namespace thimble::view {
namespace {

/// A ball above another, and a moment with their poses.
DrawnScene two_balls() {
  DrawnScene scene;
  scene.objects.push_back({.name = "still", .mesh = support::icosphere(1, 0.03)});
  scene.objects.push_back({.name = "moves", .mesh = support::icosphere(1, 0.012)});
  return scene;
}

DrawnMoment moved_to(double x) {
  DrawnMoment moment;
  moment.poses.resize(2);
  moment.poses[1].p_WB = {x, 0, 0.06};
  return moment;
}

Picture painted(ScenePainter& painter, const DrawnMoment& moment, bool shadows = true) {
  Canvas canvas(96, 64);
  Camera camera;
  camera.distance = 0.3;
  PaintChoice choice;
  choice.shadows = shadows;
  choice.marks = {.arm = false, .tip = false, .force = false, .edge_planes = false};
  painter.paint(moment, camera, choice, canvas);
  return canvas.read();
}

TEST(KeptShadows, EqualRedrawnShadowsAfterAnyMotion) {
  const auto context = support::open_gl();
  if (!context) GTEST_SKIP() << "no OpenGL";
  ScenePainter painter(two_balls(), ScenePrograms::make().value());
  // At rest twice, so that everything is stored; then moved away, at rest there, and moved back.
  for (const double x : {0.0, 0.0, 0.0, 0.03, 0.03, 0.03, 0.0, 0.0}) {
    ScenePainter fresh(two_balls(), ScenePrograms::make().value());
    EXPECT_EQ(painted(painter, moved_to(x)).rgb, painted(fresh, moved_to(x)).rgb) << x;
  }
  // A deformed object casts another shadow, although its pose is the same.
  DrawnMoment shaped = moved_to(0);
  shaped.shapes.resize(2);
  shaped.shapes[1] = std::make_shared<render::TriangleMesh>(support::icosphere(1, 0.02));
  ScenePainter fresh(two_balls(), ScenePrograms::make().value());
  const Picture larger = painted(painter, shaped);
  EXPECT_EQ(larger.rgb, painted(fresh, shaped).rgb);
  EXPECT_NE(larger.rgb, painted(painter, shaped, false).rgb);
}

TEST(ClosedSurfaces, LookAlikeFromInsideAndOutside) {
  const auto context = support::open_gl();
  if (!context) GTEST_SKIP() << "no OpenGL";
  const auto differs = [](double distance) {
    DrawnScene scene;
    scene.objects.push_back({.name = "ball", .mesh = support::icosphere(2, 0.05)});
    ScenePainter painter(scene, ScenePrograms::make().value());
    DrawnMoment away;  // outside of the picture
    away.poses.resize(1);
    away.poses[0].p_WB = {0, 100, 0};
    Canvas canvas(32, 32);
    Camera camera;
    camera.distance = distance;
    PaintChoice choice;
    choice.grid = choice.shadows = false;
    choice.edges = Edges::kOff;
    choice.marks = {.arm = false, .tip = false, .force = false, .edge_planes = false};
    painter.paint({}, camera, choice, canvas);
    const Picture one = canvas.read();
    painter.paint(away, camera, choice, canvas);
    return one.rgb != canvas.read().rgb;
  };
  EXPECT_TRUE(differs(0.3));
  EXPECT_TRUE(differs(0.02));
}

}  // namespace
}  // namespace thimble::view
