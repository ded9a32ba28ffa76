#include "thimble/scene/hand_route.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <random>

#include "surface_probe.h"

namespace thimble::app {
namespace {

using Eigen::Vector3d;

constexpr double kRadius = 0.03;  // m

// An octahedron's faces, split `splits` times and moved onto the sphere.
render::TriangleMesh sphere(int splits) {
  render::TriangleMesh mesh;
  mesh.vertices = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                    {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int split = 0; split < splits; ++split) {
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
      const auto [entry, is_new] = middles.try_emplace(std::minmax(a, b), 0);
      if (is_new) {
        entry->second = static_cast<int>(mesh.vertices.size());
        mesh.vertices.push_back((mesh.vertices[static_cast<std::size_t>(a)] +
                                 mesh.vertices[static_cast<std::size_t>(b)])
                                    .normalized());
      }
      return entry->second;
    };
    std::vector<std::array<std::int32_t, 3>> finer;
    for (const auto& [a, b, c] : mesh.triangles) {
      const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    mesh.triangles = finer;
  }
  for (Vector3d& vertex : mesh.vertices) vertex *= kRadius;
  return mesh;
}

scene::HandWaypoint on(double time, const Vector3d& near, double press) {
  scene::HandWaypoint waypoint;
  waypoint.time = time;
  waypoint.on = "sphere";
  waypoint.p_W = near;
  waypoint.press = press;
  return waypoint;
}

scene::HandWaypoint at(double time, const Vector3d& p_W) {
  scene::HandWaypoint waypoint;
  waypoint.time = time;
  waypoint.p_W = p_W;
  return waypoint;
}

driver::Result<scene::HandRoute> plan_on_sphere(const std::vector<scene::HandWaypoint>& waypoints,
                                                const render::TriangleMesh& mesh_W) {
  return scene::plan_hand(waypoints, {{"sphere", &mesh_W}});
}

TEST(SurfaceProbe, FindsTheSamePointAsALookAtEveryTriangle) {
  const render::TriangleMesh mesh = sphere(3);
  scene::SurfaceProbe probe(mesh);
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> step(-0.002, 0.002);
  Vector3d p(0.01, 0.02, 0.03);
  for (int i = 0; i < 500; ++i) {
    p += Vector3d(step(random), step(random), step(random));
    // A fresh probe gathers anew and so cannot miss anything that the walk left behind.
    scene::SurfaceProbe fresh(mesh);
    EXPECT_NEAR((probe.closest(p).p_WS - p).norm(), (fresh.closest(p).p_WS - p).norm(), 1e-15);
  }
}

TEST(HandRoute, LiesPressBelowTheSphereAllAlongTheStroke) {
  const render::TriangleMesh mesh = sphere(5);
  const double press = 0.004;
  const auto route = plan_on_sphere({on(0, {0.04, 0, 0}, press), on(1, {0.02, 0.03, 0.01}, press),
                                     on(2, {-0.01, 0.02, 0.03}, press)},
                                    mesh);
  ASSERT_TRUE(route.ok()) << route.error().message;
  EXPECT_GE(route->size(), 1000U);
  for (const auto& [time, p_W] : *route) {
    // Facets lie up to 18 um inside the sphere, and the averaging cuts corners by as much.
    EXPECT_NEAR(p_W.norm(), kRadius - press, 40e-6) << time;
  }
}

TEST(HandRoute, ChangesThePressSmoothlyFromStationToStation) {
  const auto route =
      plan_on_sphere({on(0, {0.04, 0, 0}, 0.001), on(1, {0.02, 0.03, 0}, 0.005)}, sphere(5));
  ASSERT_TRUE(route.ok());
  double last = kRadius;
  for (const auto& [time, p_W] : *route) {
    EXPECT_LE(p_W.norm(), last + 20e-6) << time;
    last = p_W.norm();
  }
  EXPECT_NEAR(last, kRadius - 0.005, 20e-6);
}

TEST(HandRoute, GrowsInTimeAndMovesAsFastAsAHandOnly) {
  const auto route =
      plan_on_sphere({at(0, {0.08, 0, 0}), on(0.8, {0.04, 0, 0}, 0.003),
                      on(1.6, {0.02, 0.03, 0.01}, 0.004), at(2.2, {0.03, 0.07, 0.03})},
                     sphere(4));
  ASSERT_TRUE(route.ok()) << route.error().message;
  EXPECT_EQ(route->front().first, 0);
  EXPECT_EQ(route->back().first, 2.2);
  Vector3d last_velocity = Vector3d::Zero();
  for (std::size_t i = 1; i < route->size(); ++i) {
    const double dt = (*route)[i].first - (*route)[i - 1].first;
    ASSERT_GT(dt, 0);
    const Vector3d velocity = ((*route)[i].second - (*route)[i - 1].second) / dt;
    EXPECT_LT(velocity.norm(), 0.2) << (*route)[i].first;
    EXPECT_LT((velocity - last_velocity).norm(), 0.02) << (*route)[i].first;
    last_velocity = velocity;
  }
  EXPECT_LT(last_velocity.norm(), 0.001);  // it ends at rest
}

TEST(HandRoute, GoesStraightThroughFreePointsWithoutAStop) {
  const auto route =
      plan_on_sphere({at(0, {0, 0, 0}), at(1, {0.1, 0, 0}), at(2, {0.2, 0, 0})}, sphere(0));
  ASSERT_TRUE(route.ok());
  for (std::size_t i = 1; i < route->size(); ++i) {
    const double dt = (*route)[i].first - (*route)[i - 1].first;
    const double speed = ((*route)[i].second - (*route)[i - 1].second).norm() / dt;
    if (std::abs((*route)[i].first - 1) < 0.1) {
      EXPECT_NEAR(speed, 0.1, 0.01);
    }
  }
}

TEST(HandRoute, RefusesAWayThroughTheMiddle) {
  const auto route =
      plan_on_sphere({on(0, {0.03, 0.001, 0}, 0.003), on(1, {-0.03, 0.0001, 0}, 0.003)}, sphere(3));
  ASSERT_FALSE(route.ok());
  EXPECT_NE(route.error().message.find("from t = 0 s to 1 s jumps"), std::string::npos)
      << route.error().message;
}

TEST(HandRoute, RefusesTimesThatDoNotGrow) {
  const auto route = plan_on_sphere({at(1, {0, 0, 0}), at(1, {0.1, 0, 0})}, sphere(0));
  ASSERT_FALSE(route.ok());
  EXPECT_NE(route.error().message.find("times must grow"), std::string::npos);
  EXPECT_FALSE(plan_on_sphere({}, sphere(0)).ok());
}

TEST(HandRoute, GoesStraightFromOneObjectToAnotherAndFollowsEach) {
  const render::TriangleMesh left = sphere(3);
  render::TriangleMesh right = left;
  for (Vector3d& vertex : right.vertices) vertex += Vector3d(0.2, 0, 0);
  scene::HandWaypoint there = on(1, {0.2, 0, 0.04}, 0);
  there.on = "other";
  const auto route =
      scene::plan_hand({on(0, {0, 0, 0.04}, 0), there}, {{"sphere", &left}, {"other", &right}});
  ASSERT_TRUE(route.ok()) << route.error().message;
  EXPECT_NEAR(route->front().second.z(), kRadius, 1e-3);
  EXPECT_NEAR(route->back().second.x(), 0.2, 1e-3);
  for (const auto& [time, p_W] : *route) EXPECT_NEAR(p_W.z(), kRadius, 1e-3);
  // And a station on nothing is told.
  there.on = "moon";
  const auto lost = scene::plan_hand({there}, {{"sphere", &left}});
  ASSERT_FALSE(lost.ok());
  EXPECT_NE(lost.error().message.find("\"moon\""), std::string::npos);
}

}  // namespace
}  // namespace thimble::app
