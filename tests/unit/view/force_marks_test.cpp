#include "view/overlays/force_marks.h"

#include <gtest/gtest.h>

#include <cmath>

#include "view/overlays/legend.h"
#include "view/overlays/tip_trail.h"

namespace thimble::view {
namespace {

driver::TickRecord tick_at(double seconds, double x, double force) {
  driver::TickRecord tick;
  tick.time_ns = static_cast<std::int64_t>(seconds * 1e9);
  tick.p_WT = {x, 0, 0};
  tick.f_sent_W = {0, 0, force};
  return tick;
}

TEST(TipTrail, KeepsLastSecondsAndStrongestForce) {
  TipTrail trail;
  std::vector<TrailPoint> points;
  for (int i = 0; i <= 10'000; ++i) {
    const double t = 1e-3 * i;
    trail.add(tick_at(t, 0.01 * t, i == 9'555 ? 3.0 : 0.5));  // 10 mm/s, one strong force
  }
  trail.copy_to(points);
  ASSERT_GT(points.size(), 50U);
  EXPECT_LE(points.size(), 401U);
  EXPECT_NEAR(points.front().p_WT.x(), 0.06, 5e-4);
  EXPECT_NEAR(points.back().p_WT.x(), 0.1, 5e-4);
  double max = 0;
  for (const TrailPoint& point : points) max = std::max(max, point.force);
  EXPECT_EQ(max, 3);
  // A resting tip and invalid ticks add nothing; another run clears the trail.
  const std::size_t before = points.size();
  trail.add(tick_at(10.001, 0.1, 0.5));
  trail.add(tick_at(10.002, NAN, 0.5));
  trail.copy_to(points);
  EXPECT_EQ(points.size(), before);
  trail.add(tick_at(0, 0, 1));
  trail.copy_to(points);
  EXPECT_EQ(points.size(), 1U);
}

TEST(ForceMarks, ScaleEndsAtRoundForceAboveTheMaximum) {
  DrawnScene scene;
  DrawnMoment moment;
  EXPECT_EQ(strongest_force(scene, moment), 0);
  scene.field.push_back({{0, 0, 0}, {0, 0, 1.2}});
  EXPECT_DOUBLE_EQ(strongest_force(scene, moment), 2);
  moment.trail.push_back({{0, 0, 0}, 4.1});
  EXPECT_DOUBLE_EQ(strongest_force(scene, moment), 5);
  moment.trail[0].force = 7.3;
  EXPECT_DOUBLE_EQ(strongest_force(scene, moment), 10);
  moment.trail[0].force = NAN;
  EXPECT_TRUE(std::isfinite(strongest_force(scene, moment)));
}

TEST(ForceMarks, PointAlongTheFieldAndSkipWeakPlaces) {
  DrawnScene scene;
  scene.field = {{{0, 0, 0}, {0, 0, 1}}, {{0.01, 0, 0}, {0, 0.5, 0}}, {{0.02, 0, 0}, {1e-3, 0, 0}}};
  ColouredMesh mesh, one;
  add_field(scene, 1, mesh);
  add_arrow({0, 0, 0}, {0, 0, 0.01}, 1e-4, kForceColour, one);
  EXPECT_EQ(mesh.vertices.size(), 2 * one.vertices.size());
  // The middle of the first arrow is at its sample, and it is no longer than the distance of the
  // samples.
  float min = 0, max = 0;
  for (std::size_t i = 0; i < one.vertices.size(); ++i) {
    min = std::min(min, mesh.vertices[i].p.z());
    max = std::max(max, mesh.vertices[i].p.z());
  }
  EXPECT_NEAR(min, -0.0045, 1e-6);
  EXPECT_NEAR(max, 0.0045, 1e-6);
  for (const ColouredVertex& vertex : mesh.vertices) EXPECT_NEAR(vertex.n.norm(), 1, 1e-5);
}

TEST(ForceMarks, LegendExplainsMissingArrowsOfViscousField) {
  DrawnScene scene;
  scene.objects.resize(2);
  scene.objects[1].name = "honey";
  scene.objects[1].field = true;
  PaintChoice choice;
  choice.fields = true;
  const Legend legend = legend_of(scene, {}, choice);
  ASSERT_EQ(legend.lines.size(), 1U);
  EXPECT_EQ(legend.lines[0].text, "honey: no force at rest, so no arrows");
  EXPECT_EQ(legend.strongest, 0);
  choice.fields = false;
  EXPECT_TRUE(legend_of(scene, {}, choice).lines.empty());
  choice.fields = true;
  scene.field.push_back({{0, 0, 0}, {0, 0, 1}});  // a sample with a force
  EXPECT_TRUE(legend_of(scene, {}, choice).lines.empty());
}

TEST(ForceMarks, DrawATrailAlongItsPointsWithoutCollapsing) {
  const std::vector<TrailPoint> trail = {{{0, 0, 0}, 0},
                                         {{0.01, 0, 0}, 1},
                                         {{0.01, 0, 0}, 1},  // the same point again
                                         {{0.01, 0.01, 0}, 2},
                                         {{0.01, 0.009, 0}, 0}};
  ColouredMesh mesh;
  add_trail(trail, 2, 1e-3, mesh);
  ASSERT_EQ(mesh.vertices.size(), 4U * 6);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const std::size_t ring = i / 6;
    const std::size_t point = ring < 2 ? ring : ring + 1;
    EXPECT_NEAR((mesh.vertices[i].p.cast<double>() - trail[point].p_WT).norm(), 1e-3, 1e-6);
  }
  EXPECT_EQ(mesh.triangles.size(), 3U * 12);
  ColouredMesh none;
  add_trail({}, 2, 1e-3, none);
  EXPECT_TRUE(none.vertices.empty());
}

}  // namespace
}  // namespace thimble::view
