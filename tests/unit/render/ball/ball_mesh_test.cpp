// A tip that is a ball, on meshes, against the distance from all triangles.

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "ball/ball_contact.h"
#include "ball/mesh_ball.h"
#include "mesh/closest_point.h"
#include "search/make_search.h"
#include "support/long_form.h"
#include "support/meshes/shapes.h"
#include "support/random.h"
#include "support/tip_at.h"
#include "thimble/render/build_object_touch.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;
using support::Random;
using support::tip_at;

BallContact<MeshBall> ball_on(const TriangleMesh& mesh, double radius) {
  auto built = std::make_shared<const ContactMesh>(ContactMesh::build(mesh).value());
  return BallContact(
      MeshBall(std::make_shared<const TriangleTree>(built), make_search(*built, {}), radius));
}

/// Distance of a point from a mesh, and the directions from its closest points, by all triangles.
struct Near {
  double distance = 1e300;
  std::vector<Vector3d> normals;  ///< From points no farther than the distance + 1e-7 m.
};

Near near_by_all(const TriangleMesh& mesh, const Vector3d& q) {
  std::vector<std::pair<double, Vector3d>> all;
  Near near;
  for (const auto& t : mesh.triangles) {
    const Vector3d c = closest_point(q, mesh.vertices[static_cast<std::size_t>(t[0])],
                                     mesh.vertices[static_cast<std::size_t>(t[1])],
                                     mesh.vertices[static_cast<std::size_t>(t[2])]);
    all.emplace_back((q - c).norm(), (q - c).normalized());
    near.distance = std::min(near.distance, all.back().first);
  }
  for (const auto& [distance, n] : all) {
    if (distance > near.distance + 1e-7) continue;
    const auto same = [&n = n](const Vector3d& other) { return (other - n).norm() < 1e-9; };
    if (std::none_of(near.normals.begin(), near.normals.end(), same)) near.normals.push_back(n);
  }
  return near;
}

/// Distance of v from the cone of up to three of the normals.
double off_cone(const std::vector<Vector3d>& normals, const Vector3d& v) {
  double best = v.norm();
  const auto attempt = [&](const Eigen::Matrix3Xd& N) {
    const Eigen::VectorXd x = N.colPivHouseholderQr().solve(v);
    if (x.minCoeff() < -1e-9 * v.norm()) return;
    best = std::min(best, (N * x - v).norm());
  };
  for (std::size_t i = 0; i < normals.size(); ++i) {
    attempt(normals[i]);
    for (std::size_t k = i + 1; k < normals.size(); ++k) {
      Eigen::Matrix3Xd two(3, 2);
      two << normals[i], normals[k];
      attempt(two);
      for (std::size_t m = k + 1; m < normals.size(); ++m) {
        Eigen::Matrix3Xd three(3, 3);
        three << normals[i], normals[k], normals[m];
        attempt(three);
      }
    }
  }
  return best;
}

// Half of the triangles are nearer than all others: the search of the tree ends with them.
TEST(BallMesh, AFullListOfTrianglesIsComplete) {
  const auto built = std::make_shared<const ContactMesh>(
      ContactMesh::build(support::torus(0.02, 0.004, 16, 8)).value());
  const TriangleTree tree(built);
  std::vector<NearTriangle> list(static_cast<std::size_t>(built->triangle_count() / 2));
  for (const Vector3d& q : {Vector3d(0.1, 0, 0), Vector3d(0, -0.1, 0), Vector3d(0.03, 0.04, 0)}) {
    std::size_t count = 0;
    const double reach = tree.near(q, 1, list, count);
    ASSERT_EQ(count, list.size());
    std::size_t nearer = 0;
    for (std::int32_t t = 0; t < built->triangle_count(); ++t) {
      const Vector3d c =
          closest_point(q, built->position(t, 0), built->position(t, 1), built->position(t, 2));
      nearer += (q - c).norm() < reach * (1 - 1e-12) ? 1 : 0;
    }
    EXPECT_LE(nearer, count);
  }
}

// Each triangle that the ball may reach in a step is behind the plane of a feature.
TEST(BallMesh, EachTriangleInReachIsBehindAFeature) {
  for (const TriangleMesh& mesh :
       {support::torus(0.01, 0.002, 40, 4), support::bumpy_sphere(2, 0.01, 0.1, 5)}) {
    const auto built = std::make_shared<const ContactMesh>(ContactMesh::build(mesh).value());
    MeshBall ball(std::make_shared<const TriangleTree>(built), make_search(*built, {}), 0.0005);
    Random random(6);
    int asked = 0;
    Vector3d q(0, 0, 0.01);
    for (int i = 0; i < 6000; ++i) {
      // Mostly near the last place, so that the list of triangles is that of another centre.
      q = i % 16 == 0 ? random.in_box(0.02) : Vector3d(q + random.in_box(3e-4));
      if (ball.inside(q)) continue;
      double reach = random.uniform(0, random.uniform(0, 1) < 0.5 ? 3e-4 : 3e-3);
      const auto features = ball.features(q, reach);
      for (std::int32_t t = 0; t < built->triangle_count(); ++t) {
        const double gap = ball.feature(t, q).gap;
        if (!(gap < reach)) continue;
        ++asked;
        const bool held = std::any_of(features.begin(), features.end(), [&](const auto& one) {
          for (std::size_t k = 0; k < 3; ++k) {
            if (one.n_W.dot(built->position(t, k) - one.p_W) > 1e-12) return false;
          }
          return true;
        });
        ASSERT_TRUE(held) << i << ", triangle " << t << ", gap " << gap;
      }
    }
    EXPECT_GT(asked, 1000);
  }
}

struct Found {
  int ticks = 0, touching = 0, several = 0, bent = 0, off_count = 0;
  double inside = 0;  ///< Greatest lack of distance, m.
  double off = 0;     ///< Greatest distance of proxy - tip from the cone of the normals, m.
  std::uint64_t unsettled = 0;
  bool crossed = false;  ///< Whether the proxy was inside of the mesh.
};

Found wander(const TriangleMesh& mesh, double radius, double size, double depth_max, Random& random,
             int ticks) {
  BallContact<MeshBall> ball = ball_on(mesh, radius);
  const auto search = make_search(ball.mesh(), {});
  Found found;
  Vector3d p(0, 0, 3 * size), target = p;
  for (int tick = 0; tick < ticks; ++tick) {
    if (random.uniform(0, 1) < 0.01) target = random.in_box(size);
    p += random.uniform(0, 4e-4) * (target - p).normalized();
    const Vector3d deep = p - ball.state().p_WP;
    if (ball.state().touching && deep.norm() > depth_max) p -= (1 - depth_max / deep.norm()) * deep;
    const ContactState state = ball.update(tip_at(p));
    ++found.ticks;
    if (!state.touching) continue;
    ++found.touching;
    if (ball.held().size() > 1) ++found.several;
    for (const BallFeature& held : ball.held()) {
      if (held.kind != BallFeature::Kind::kFace) {
        ++found.bent;
        break;
      }
    }
    const Near near = near_by_all(mesh, state.p_WP);
    found.inside = std::max(found.inside, radius - near.distance);
    found.crossed = found.crossed || search->inside(state.p_WP);
    const double off = off_cone(near.normals, state.p_WP - p);
    if (off > 1e-9) ++found.off_count;
    found.off = std::max(found.off, off);
  }
  found.unsettled = ball.unsettled();
  return found;
}

void expect_exact(const std::string& name, const Found& found) {
  std::printf(
      "%s: %d of %d ticks touch, %d several parts, %d edges or corners; %.1e m inside, %.1e m off "
      "the cone, more than 1e-9 m in %d; %d unsettled\n",
      name.c_str(), found.touching, found.ticks, found.several, found.bent, found.inside, found.off,
      found.off_count, static_cast<int>(found.unsettled));
  EXPECT_GT(found.touching, found.ticks / 5) << name;
  EXPECT_LT(found.inside, 1e-9) << name;
  EXPECT_FALSE(found.crossed) << name;
  EXPECT_LE(found.off_count, static_cast<int>(found.unsettled)) << name;
  EXPECT_LE(found.unsettled, static_cast<std::uint64_t>(found.touching / 100)) << name;
}

TriangleMesh rough_sphere(Random& random, int subdivisions, double radius, double roughness) {
  TriangleMesh mesh = support::icosphere(subdivisions, radius);
  for (Vector3d& v : mesh.vertices) v *= 1 + random.uniform(-roughness, roughness);
  return mesh;
}

TEST(BallMesh, RestsAgainstThePartsThatItTouches) {
  Random random(710);
  const int ticks = support::long_form() ? 100'000 : 6000;
  for (const double radius : {0.0005, 0.004, 0.012}) {
    for (const double depth_max : {0.0004, 0.004}) {
      const std::string how =
          "R " + std::to_string(radius) + ", depth " + std::to_string(depth_max) + ", ";
      expect_exact(how + "rough ball", wander(rough_sphere(random, 2, 0.02, 0.15), radius, 0.025,
                                              depth_max, random, ticks));
      expect_exact(how + "fine rough ball", wander(rough_sphere(random, 3, 0.02, 0.03), radius,
                                                   0.025, depth_max, random, ticks / 2));
      expect_exact(how + "torus", wander(support::torus(0.02, 0.008, 24, 12), radius, 0.03,
                                         depth_max, random, ticks));
      expect_exact(how + "box", wander(support::box({0.015, 0.01, 0.012}), radius, 0.02, depth_max,
                                       random, ticks));
    }
  }
}

TEST(BallMesh, ASphereOfTrianglesKeepsItsExactDistance) {
  const double r = 0.02, R = 0.004;
  const TriangleMesh mesh = support::icosphere(4, r);
  BallContact<MeshBall> ball = ball_on(mesh, R);
  Random random(711);
  ball.update(tip_at({0, 0, 0.05}));
  double off = 0, least = 1;
  for (int i = 0; i < 3000; ++i) {
    const double s = 2e-3 * i;
    const Vector3d towards(std::sin(s), std::cos(s) * std::sin(0.3 * s), std::cos(s));
    const ContactState state = ball.update(tip_at((r + R - 0.0015) * towards.normalized()));
    if (i == 0) continue;
    ASSERT_TRUE(state.touching);
    off = std::max(off, std::abs(near_by_all(mesh, state.p_WP).distance - R));
    least = std::min(least, state.p_WP.norm());
  }
  EXPECT_LT(off, 1e-9);
  // Within what the triangles lack of the sphere.
  EXPECT_GT(least, r + R - 2.5e-5);
}

TEST(BallMesh, APathMeetsTheMeshWhereItsDistanceIsTheRadius) {
  Random random(712);
  const TriangleMesh mesh = rough_sphere(random, 2, 0.02, 0.15);
  BallContact<MeshBall> ball = ball_on(mesh, 0.003);
  MeshBall& source = ball.source();
  int met = 0, missed = 0;
  for (int i = 0; i < 3000; ++i) {
    const Vector3d from = 0.06 * random.direction(), to = random.in_box(0.06);
    const SolidEntry entry = source.first_entry(from, to);
    const double end = entry.triangle >= 0 ? entry.parameter : 1;
    double least = 1;
    for (int k = 0; k <= 20; ++k) {
      const Vector3d x = from + 0.05 * k * end * (to - from);
      least = std::min(least, near_by_all(mesh, x).distance);
    }
    ASSERT_GT(least, 0.003 - 1e-12);
    if (entry.triangle < 0) {
      ++missed;
      continue;
    }
    ++met;
    ASSERT_NEAR(near_by_all(mesh, from + end * (to - from)).distance, 0.003, 1e-12);
    // A path that begins inside enters nothing.
    ASSERT_LT(source.first_entry(0.005 * random.direction(), to).triangle, 0);
  }
  EXPECT_GT(met, 300);
  EXPECT_GT(missed, 300);
}

double tick_time(ObjectTouch& touch, double r, int ticks) {
  double least = 1e9;
  touch.update(tip_at({0, 0, 1}));
  for (int round = 0; round < 4; ++round) {
    const std::clock_t begin = std::clock();
    for (int i = 0; i < ticks; ++i) {
      const double s = 5e-3 * i;
      touch.update(tip_at({r * std::sin(s), r * std::cos(s) * std::sin(0.01 * s),
                           r * std::cos(s) * std::cos(0.01 * s)}));
    }
    least = std::min(least, static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC / ticks);
  }
  return 1e9 * least;
}

TEST(BallCost, IsReportedAgainstAPoint) {
  for (const int subdivisions : {3, 5}) {
    const TriangleMesh mesh = support::icosphere(subdivisions, 0.02);
    for (const double R : {0.0, 0.0005, 0.004, 0.01}) {
      const auto touch =
          build_object_touch(mesh, {.tracker = TrackerChoice::kGodObject, .tip_radius = R},
                             {.spring = {.stiffness = 800}})
              .value();
      const double far = tick_time(*touch, 0.06, 20'000),
                   near = tick_time(*touch, 0.0205 + R, 20'000),
                   touching = tick_time(*touch, 0.019 + R, 20'000);
      std::printf("%zu triangles, R = %.1f mm: %.0f ns far, %.0f ns at 0.5 mm, %.0f ns touching\n",
                  mesh.triangles.size(), 1e3 * R, far, near, touching);
    }
  }
}

}  // namespace
}  // namespace thimble::render
