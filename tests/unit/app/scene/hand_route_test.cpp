#include "thimble/scene/hand_route.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <map>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "hand/place_text.h"
#include "hand/sphere_tree.h"
#include "hand/surface_probe.h"
#include "hand/surface_route.h"
#include "mesh/closest_point.h"
#include "support/meshes/shapes.h"
#include "support/seed.h"
#include "thimble/render/mesh/mesh_file.h"

namespace thimble::scene {
namespace {

using Eigen::Vector3d;

constexpr double kRadius = 0.03;  // m

// Returns the faces of an octahedron, split `splits` times and projected onto the sphere.
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

TEST(SurfaceProbe, FindsTheSamePointAsBruteForce) {
  const render::TriangleMesh mesh = sphere(3);
  scene::SurfaceProbe probe(mesh);
  std::mt19937_64 random(support::seed_of(3));
  std::uniform_real_distribution<double> step(-0.002, 0.002);
  Vector3d p(0.01, 0.02, 0.03);
  for (int i = 0; i < 500; ++i) {
    p += Vector3d(step(random), step(random), step(random));
    double nearest = 1;
    for (const auto& [a, b, c] : mesh.triangles) {
      const auto at = [&mesh](std::int32_t v) {
        return mesh.vertices[static_cast<std::size_t>(v)];
      };
      nearest = std::min(nearest, (render::closest_point(p, at(a), at(b), at(c)) - p).norm());
    }
    EXPECT_NEAR((probe.closest(p).p_WS - p).norm(), nearest, 1e-15);
  }
}

TEST(SphereTree, MatchesBruteForce) {
  std::mt19937_64 random(support::seed_of(5));
  std::uniform_real_distribution<double> place(-0.1, 0.1), size(0, 0.01);
  for (const int count : {0, 1, 8, 9, 100, 1000}) {
    std::vector<scene::SphereTree::Sphere> spheres(static_cast<std::size_t>(count));
    for (auto& sphere : spheres) {
      // Arranged in rows, so that many spheres are equally far along one axis.
      sphere.center = {place(random), std::round(50 * place(random)) / 50, 0};
      sphere.radius = size(random);
    }
    const scene::SphereTree tree(spheres);
    std::vector<std::size_t> found;
    for (int i = 0; i < 50; ++i) {
      const Vector3d p(place(random), place(random), place(random));
      double nearest = std::numeric_limits<double>::infinity();
      for (const auto& sphere : spheres) {
        nearest = std::min(nearest, sphere.distance(p) + sphere.radius);
      }
      EXPECT_EQ(tree.nearest_far_side(p), nearest);
      std::vector<std::size_t> expected;
      for (std::size_t k = 0; k < spheres.size(); ++k) {
        if (spheres[k].distance(p) - spheres[k].radius <= 0.05) expected.push_back(k);
      }
      tree.find_within(p, 0.05, found);
      EXPECT_EQ(found, expected);
    }
  }
}

TEST(HandRoute, StaysAtPressDepthBelowTheSphere) {
  const render::TriangleMesh mesh = sphere(5);
  const double press = 0.004;
  const auto route = plan_on_sphere({on(0, {0.04, 0, 0}, press), on(1, {0.02, 0.03, 0.01}, press),
                                     on(2, {-0.01, 0.02, 0.03}, press)},
                                    mesh);
  ASSERT_TRUE(route.ok()) << route.error().message;
  EXPECT_GE(route->size(), 1000U);
  for (const auto& [time, p_W] : *route) {
    // Facets are up to 18 um inside the sphere, and averaging cuts corners by the same amount.
    EXPECT_NEAR(p_W.norm(), kRadius - press, 40e-6) << time;
  }
}

TEST(HandRoute, ChangesThePressSmoothlyBetweenWaypoints) {
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

TEST(HandRoute, HasIncreasingTimesAndHandSpeeds) {
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
  EXPECT_LT(last_velocity.norm(), 0.001);  // the route ends at rest
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

// Expects that a route stays on a surface: each point is within `reach` of it, and there is no
// jump.
void expect_on_surface(const scene::HandRoute& route, const render::TriangleMesh& mesh_W,
                       double reach, const std::string& what) {
  scene::SurfaceProbe probe(mesh_W);
  for (std::size_t i = 0; i < route.size(); ++i) {
    const Vector3d& p = route[i].second;
    ASSERT_TRUE(p.allFinite()) << what;
    ASSERT_LE((probe.closest(p).p_WS - p).norm(), reach) << what << " at " << route[i].first;
    if (i == 0) continue;
    ASSERT_LE((p - route[i - 1].second).norm(), 0.01) << what << " at " << route[i].first;
  }
}

TEST(HandRoute, AvoidsTheInteriorOfTheObject) {
  const render::TriangleMesh mesh = sphere(4);
  const double press = 0.003;
  const auto route =
      plan_on_sphere({on(0, {0.03, 0.001, 0}, press), on(1, {-0.03, 0.0001, 0}, press)}, mesh);
  ASSERT_TRUE(route.ok()) << route.error().message;
  double length = 0;
  for (std::size_t i = 0; i < route->size(); ++i) {
    EXPECT_NEAR((*route)[i].second.norm(), kRadius - press, 200e-6);  // facets are 70 um inside
    if (i > 0) length += ((*route)[i].second - (*route)[i - 1].second).norm();
  }
  EXPECT_NEAR(length, M_PI * (kRadius - press), 0.02 * length);  // nearly a great circle
  EXPECT_LT((route->back().second - Vector3d(-kRadius + press, 0, 0)).norm(), 0.001);
}

TEST(HandRoute, GoesOverTheEdgesOfACube) {
  const render::TriangleMesh cube = support::box(Vector3d::Constant(0.02));
  for (const Vector3d& goal : {Vector3d(0.02, 0.005, 0.003), Vector3d(0.01, -0.004, -0.02)}) {
    const auto route = plan_on_sphere({on(0, {0, 0, 0.02}, 0.002), on(1, goal, 0.002)}, cube);
    ASSERT_TRUE(route.ok()) << route.error().message;
    expect_on_surface(*route, cube, 0.004, "cube");
    EXPECT_LT((route->back().second - goal).norm(), 0.004);
  }
}

/// Two cubes of 20 mm, 60 mm apart, in one mesh.
render::TriangleMesh two_cubes() {
  render::TriangleMesh two = support::box(Vector3d::Constant(0.01));
  const render::TriangleMesh other = two;
  for (const Vector3d& p : other.vertices) two.vertices.push_back(p + Vector3d(0.06, 0, 0));
  for (const auto& [a, b, c] : other.triangles) two.triangles.push_back({a + 8, b + 8, c + 8});
  return two;
}

TEST(HandRoute, BeginsADetourThroughSpaceAtTheTarget) {
  const render::TriangleMesh two = two_cubes();
  const auto route =
      plan_on_sphere({on(0, {0, 0, 0.01}, 0.001), on(1, {0.06, 0, 0.01}, 0.001)}, two);
  ASSERT_TRUE(route.ok()) << route.error().message;
  // A hand that starts from rest has moved less than 0.1 mm after 2 % of its time.
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_LT(((*route)[i].second - Vector3d(0, 0, 0.009)).norm(), 1e-4) << i;
  }
}

TEST(SurfaceRoute, PathIsCloselySpaced) {
  const render::TriangleMesh cube = support::box(Vector3d::Constant(0.03));
  SurfaceProbe probe(cube);
  SurfaceRoute route(cube, probe);
  const std::vector<Vector3d> path = route.over_surface({0, 0, 0.03}, {0, 0, -0.03});
  ASSERT_GT(path.size(), 2U);
  const double size = 2 * 0.03 * std::sqrt(3.0);
  for (std::size_t i = 1; i < path.size(); ++i) {
    EXPECT_LT((path[i] - path[i - 1]).norm(), size / 50) << i;
  }
}

TEST(HandRoute, LeavesTheSurfaceBetweenUnconnectedParts) {
  const render::TriangleMesh two = two_cubes();
  const auto route =
      plan_on_sphere({on(0, {0, 0, 0.01}, 0.001), on(1, {0.06, 0, 0.01}, 0.001)}, two);
  ASSERT_TRUE(route.ok()) << route.error().message;
  EXPECT_LT((route->front().second - Vector3d(0, 0, 0.009)).norm(), 1e-6);
  EXPECT_LT((route->back().second - Vector3d(0.06, 0, 0.009)).norm(), 1e-6);
  for (std::size_t i = 1; i < route->size(); ++i) {
    EXPECT_LT(((*route)[i].second - (*route)[i - 1].second).norm(), 0.002);
  }
  // There is no path from the outside into a cavity.
  const render::TriangleMesh other = support::box(Vector3d::Constant(0.01));
  render::TriangleMesh hollow = support::box(Vector3d::Constant(0.02));
  for (const Vector3d& p : other.vertices) hollow.vertices.push_back(p);
  for (const auto& [a, b, c] : other.triangles) hollow.triangles.push_back({a + 8, c + 8, b + 8});
  const auto none = plan_on_sphere({on(0, {0, 0, 0.02}, 0), on(1, {0, 0, 0.01}, 0)}, hollow);
  ASSERT_FALSE(none.ok());
  EXPECT_NE(none.error().message.find("no path from t = 0 s to 1 s over \"sphere\""),
            std::string::npos)
      << none.error().message;
}

// Random strokes over plain and shipped meshes. Without detours most of them would be rejected.
TEST(HandRoute, GoesEveryStrokeOverPlainAndShippedMeshes) {
  std::vector<std::pair<std::string, render::TriangleMesh>> meshes{
      {"cube", support::box(Vector3d::Constant(0.03))},
      {"plate", support::plate(0.08, 0.002, 4)},
      {"needle", support::needle(12, 0.06, 0.01)},
      {"wedge", support::wedge(0.3, 0.06, 0.04)},
      {"ball", support::icosphere(3, 0.03)},
      {"bumpy ball", support::bumpy_sphere(3, 0.03, 0.3, 6)},
      {"torus", support::torus(0.03, 0.01, 40, 20)}};
  for (const char* name : {"clay_ball", "soft_coarse", "tin_can", "trampoline", "water_balloon"}) {
    auto mesh = render::load_mesh(std::filesystem::path(THIMBLE_SOURCE_DIR) / "app/scenes" /
                                  (std::string(name) + ".off"));
    ASSERT_TRUE(mesh.ok()) << mesh.error().message;
    Eigen::AlignedBox3d box;
    for (const Vector3d& p : mesh->vertices) box.extend(p);
    meshes.emplace_back(name, render::placed(*mesh, 0.08 / box.sizes().maxCoeff(),
                                             Eigen::Matrix3d::Identity(), {0, 0, 0}));
  }
  std::mt19937_64 bits(support::seed_of(41));
  const auto share = [&bits] { return static_cast<double>(bits() >> 11) * 0x1p-53; };
  int strokes = 0, refused = 0;
  for (const auto& entry : meshes) {
    const std::string& name = entry.first;
    const render::TriangleMesh& mesh = entry.second;
    const auto point = [&] {
      const auto& t = mesh.triangles[bits() % mesh.triangles.size()];
      const double u = share(), v = share() * (1 - u);
      const auto at = [&](std::size_t k) { return mesh.vertices[static_cast<std::size_t>(t[k])]; };
      return Vector3d(at(0) + u * (at(1) - at(0)) + v * (at(2) - at(0)));
    };
    for (int i = 0; i < 20; ++i) {
      const auto route = plan_on_sphere(
          {on(0, point(), 0.001), on(1.5, point(), 0.001), on(3, point(), 0.001)}, mesh);
      ++strokes;
      if (!route) {
        ++refused;
        ADD_FAILURE() << name << ": " << route.error().message;
        continue;
      }
      // A press is 1 mm deep, and passes through thinner parts. Averaging over 60 ms cuts corners
      // of a fast hand.
      expect_on_surface(*route, mesh, 0.006, name);
    }
  }
  std::printf("%d of %d random strokes refused\n", refused, strokes);
}

TEST(HandRoute, RejectsTimesThatDoNotIncrease) {
  const auto route = plan_on_sphere({at(1, {0, 0, 0}), at(1, {0.1, 0, 0})}, sphere(0));
  ASSERT_FALSE(route.ok());
  EXPECT_NE(route.error().message.find("times must increase"), std::string::npos);
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
  // A waypoint on an unknown object is reported.
  there.on = "moon";
  const auto lost = scene::plan_hand({there}, {{"sphere", &left}});
  ASSERT_FALSE(lost.ok());
  EXPECT_NE(lost.error().message.find("\"moon\""), std::string::npos);
}

TEST(PlaceText, HasNoNegativeZero) {
  EXPECT_EQ(scene::place_text({-0.04, 29.94, -1e-300}, 1), "(0.0, 29.9, 0.0)");
  EXPECT_EQ(scene::place_text({-0.06, -12, NAN}, 1), "(-0.1, -12.0, nan)");
}

}  // namespace
}  // namespace thimble::scene
