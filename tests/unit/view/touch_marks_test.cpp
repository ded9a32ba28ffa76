#include "view/touch_marks.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "support/meshes/shapes.h"

namespace thimble::view {
namespace {

using Eigen::Vector3d;

DrawnMoment moment_with(const Eigen::Matrix3d& R_WT) {
  DrawnMoment moment;
  moment.tick.p_WT = {0.01, 0.02, 0.03};
  moment.tick.q_WT = driver::quaternion_of(R_WT);
  return moment;
}

/// Returns the end of the stylus: the far end of its longest drawn rod.
Vector3d end_of_stylus(const DrawnMoment& moment) {
  const MarkChoice only_arm{.arm = true, .tip = false, .force = false, .edge_planes = false};
  Vector3d end(0, 0, 0);
  double longest = 0;
  for (const Solid& solid : mark_touch({}, moment, 1, only_arm).solids) {
    if (solid.kind != SolidKind::kRod) continue;
    const Vector3d to = (solid.model * Eigen::Vector4f(0, 0, 1, 1)).head<3>().cast<double>();
    const Vector3d from = (solid.model * Eigen::Vector4f(0, 0, 0, 1)).head<3>().cast<double>();
    if ((to - from).norm() > longest) {
      longest = (to - from).norm();
      end = to;
    }
  }
  return end;
}

TEST(TouchMarks, StylusFollowsReportedOrientation) {
  const Vector3d tip(0.01, 0.02, 0.03);
  for (const double angle : {0.0, 0.7, -2.1}) {
    const Eigen::Matrix3d R_WT =
        Eigen::AngleAxisd(angle, Vector3d(1, 1, 0.3).normalized()).toRotationMatrix();
    const Vector3d along = (end_of_stylus(moment_with(R_WT)) - tip).normalized();
    EXPECT_LT((along - R_WT.col(0)).norm(), 1e-5) << angle;
  }
}

TEST(TouchMarks, ShowNoStylusWithoutOrientation) {
  DrawnMoment moment;
  const MarkChoice only_arm{.arm = true, .tip = false, .force = false, .edge_planes = false};
  EXPECT_TRUE(mark_touch({}, moment, 1, only_arm).solids.empty());
  // A roll about its own axis is visible, because a part of it moves.
  const auto rolled = [&](double angle) {
    const Eigen::Matrix3d R_WT = Eigen::AngleAxisd(angle, Vector3d::UnitX()).toRotationMatrix();
    return mark_touch({}, moment_with(R_WT), 1, only_arm).solids.back().model;
  };
  EXPECT_GT((rolled(0) - rolled(1)).norm(), 1e-3);
}

TEST(TouchMarks, ForcesOfSeveralArmsShineThroughObjects) {
  const auto shine = [](bool several) {
    DrawnMoment moment;
    moment.tick.f_sent_W = {0, 0, 2};
    if (several) moment.others.emplace_back().tick.f_sent_W = {0, 1, 0};
    const MarkChoice only_force{.arm = false, .tip = false, .force = true};
    std::size_t shining = 0;
    for (const Solid& solid : mark_touch({}, moment, 1, only_force).solids) {
      shining += solid.shines_through ? 1 : 0;
    }
    return shining;
  };
  EXPECT_EQ(shine(false), 0U);
  EXPECT_EQ(shine(true), 4U);  // a rod and a cone for each arm
}

TEST(TouchMarks, ArmsOfSeveralRecordingsHaveTheirColours) {
  const Colour blue = colour_of(0x0072B2);
  const Colour red = colour_of(0xD55E00);
  DrawnMoment moment;
  moment.tick.f_sent_W = {0, 0, 2};
  moment.look.colour = blue;
  DrawnArm& other = moment.others.emplace_back();
  other.tick.f_sent_W = {0, 1, 0};
  other.look.colour = red;
  const MarkChoice tips{.arm = false};
  const auto count = [&](const Colour& colour) {
    const auto marks = mark_touch({}, moment, 1, tips);
    return std::count_if(marks.solids.begin(), marks.solids.end(),
                         [&](const Solid& solid) { return solid.colour == colour; }) +
           std::count_if(marks.labels.begin(), marks.labels.end(),
                         [&](const Label& label) { return label.colour == colour; });
  };
  EXPECT_EQ(count(blue), 4);  // rod and cone of the force, tip and number
  EXPECT_EQ(count(red), 4);
  other.look.ended = true;  // only its tip is left
  EXPECT_EQ(count(blue), 4);
  EXPECT_EQ(count(red), 1);
}

TEST(TouchMarks, ShowNormalAndTangentialForce) {
  DrawnMoment moment;
  moment.tick.in_contact = true;
  moment.tick.n_W = {0, 0, 1};
  moment.tick.f_sent_W = {0.3, 0, 1};
  MarkChoice choice{.arm = false, .tip = false, .force = false, .edge_planes = false};
  EXPECT_TRUE(mark_touch({}, moment, 1, choice).solids.empty());
  choice.contact = true;
  const TouchMarks both = mark_touch({}, moment, 1, choice);
  EXPECT_EQ(both.solids.size(), 4U);
  ASSERT_EQ(both.labels.size(), 1U);
  EXPECT_EQ(both.labels[0].text, "0.30 N");
  EXPECT_NEAR((both.labels[0].away_W - Vector3d(1, 0, 0)).norm(), 0, 1e-12);
  moment.tick.f_sent_W = {0, 0, 1};
  EXPECT_TRUE(mark_touch({}, moment, 1, choice).labels.empty());
  moment.tick.in_contact = false;
  EXPECT_TRUE(mark_touch({}, moment, 1, choice).solids.empty());
  moment.tick.in_contact = true;
  moment.tick.n_W = {NAN, 0, 1};
  EXPECT_TRUE(mark_touch({}, moment, 1, choice).solids.empty());
}

/// Returns the position and the radius of each drawn ball.
std::vector<std::pair<Vector3d, double>> balls_of(const TouchMarks& marks) {
  std::vector<std::pair<Vector3d, double>> balls;
  for (const Solid& solid : marks.solids) {
    if (solid.kind != SolidKind::kBall) continue;
    const Vector3d at = (solid.model * Eigen::Vector4f(0, 0, 0, 1)).head<3>().cast<double>();
    balls.emplace_back(at, solid.model.col(0).head<3>().norm());
  }
  return balls;
}

TEST(TouchMarks, DrawsATipWithARadiusWhereItRests) {
  DrawnScene scene;
  scene.tip_radius = 0.004;
  DrawnMoment moment;
  moment.tick.p_WT = {0.01, 0.02, 0.03};
  const MarkChoice only_tip{.arm = false, .tip = true, .force = false, .edge_planes = false};
  const double thick = 0.0032;
  auto balls = balls_of(mark_touch(scene, moment, 1, only_tip));
  ASSERT_EQ(balls.size(), 2U);
  EXPECT_NEAR(balls[0].second, 0.004, 1e-8);
  EXPECT_LT((balls[0].first - Vector3d(0.01, 0.02, 0.03)).norm(), 1e-8);

  moment.tick.in_contact = true;
  moment.tick.n_W = {0, 0, 1};
  moment.tick.p_WP = {0.01, 0.02, 0.032};
  balls = balls_of(mark_touch(scene, moment, 1, only_tip));
  ASSERT_EQ(balls.size(), 3U);
  // Around the proxy; its amber mark is where the ball touches.
  EXPECT_LT((balls[0].first - Vector3d(0.01, 0.02, 0.032)).norm(), 1e-8);
  EXPECT_LT((balls[2].first - Vector3d(0.01, 0.02, 0.028)).norm(), 1e-8);
  EXPECT_NEAR(balls[2].second, 1.7 * thick, 1e-8);
  // A point has no such ball.
  EXPECT_EQ(balls_of(mark_touch({}, moment, 1, only_tip)).size(), 2U);
}

}  // namespace
}  // namespace thimble::view
