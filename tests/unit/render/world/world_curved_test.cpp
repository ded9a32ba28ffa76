// Curved solids that overlap: the proxy is outside of all of them, and the tip presses it against
// those it touches.

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <utility>
#include <vector>

#include "support/long_form.h"
#include "support/random.h"
#include "support/tip_at.h"
#include "thimble/render/build_primitive_touch.h"
#include "thimble/render/scene_touch.h"
#include "track/path_bounded.h"
#include "world/contact_world.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;
using support::Random;

constexpr double kStiffness = 800;
constexpr double kSize = 0.04;  // m, of a scene

/// Signed distance and outward normal of a surface.
struct Surface {
  double distance = 0;
  Vector3d n{0, 0, 0};
};

Surface surface_of(const Sphere& sphere, const Vector3d& p) {
  const Vector3d from = p - sphere.p_WO;
  return {from.norm() - sphere.radius, from.normalized()};
}
Surface surface_of(const HalfSpace& plane, const Vector3d& p) {
  return {plane.n_W.dot(p - plane.p_WO), plane.n_W};
}

/// Distance of v from the cone of up to three of the normals: by all subsets, with a least-squares
/// solution each.
double off_cone(const std::vector<Vector3d>& normals, const Vector3d& v) {
  double best = v.norm();
  const std::size_t count = normals.size();
  for (std::uint32_t subset = 1; subset < (1u << count); ++subset) {
    Eigen::Matrix3Xd N(3, 0);
    for (std::size_t i = 0; i < count; ++i) {
      if ((subset >> i & 1u) == 0) continue;
      N.conservativeResize(3, N.cols() + 1);
      N.col(N.cols() - 1) = normals[i];
    }
    if (N.cols() > 3) continue;
    const Eigen::VectorXd x = N.colPivHouseholderQr().solve(v);
    if (x.minCoeff() < -1e-9 * v.norm()) continue;
    best = std::min(best, (N * x - v).norm());
  }
  return best;
}

/// What a tip found among curved solids.
struct Found {
  int several = 0;    ///< Ticks with several active solids.
  int acute = 0;      ///< Of these, ticks in a groove of less than 60 degrees.
  double inside = 0;  ///< Greatest depth of the proxy in a solid, m.
  int off_count = 0;  ///< Ticks with proxy - tip farther than 1e-9 m from the cone of the normals.
  double off = 0;     ///< Greatest distance from that cone, m.
  double force_off = 0;  ///< Greatest difference of the force from that of the proxy, N.
  std::uint64_t unsettled = 0;
};

Found wander(Random& random, int ticks, double depth_max) {
  std::vector<Sphere> spheres;
  const auto count = static_cast<std::size_t>(random.uniform(1, 7));
  for (std::size_t i = 0; i < count; ++i) {
    spheres.push_back({.p_WO = random.in_box(0.02), .radius = random.uniform(0.004, 0.02)});
  }
  const HalfSpace plane{.n_W = {0, 0, 1}, .p_WO = {0, 0, random.uniform(-0.02, 0)}};
  std::vector<std::unique_ptr<ObjectTouch>> objects;
  objects.push_back(build_primitive_touch(plane, {.spring = {.stiffness = kStiffness}}));
  for (const Sphere& sphere : spheres) {
    objects.push_back(build_primitive_touch(sphere, {.spring = {.stiffness = kStiffness}}));
  }
  SceneTouch scene(std::move(objects));
  Found result;
  Vector3d p(0, 0, 0.1), target = random.in_box(0.02);
  scene(support::tip_at(p));
  ProxyFilter filter;
  filter.follow(p, {});
  for (int tick = 0; tick < ticks; ++tick) {
    if (random.uniform(0, 1) < 0.004) target = random.in_box(0.025);
    const Vector3d way = target - p;
    p += std::min(1.0, random.uniform(0, 2e-4) / way.norm()) * way;
    const Vector3d deep = p - scene.world()->proxy();
    if (deep.norm() > depth_max) p -= (1 - depth_max / deep.norm()) * deep;
    const driver::ForceCommand command = scene(support::tip_at(p));
    const Vector3d q = scene.world()->proxy();
    std::vector<Vector3d> normals;
    const auto look = [&](const Surface& surface) {
      result.inside = std::max(result.inside, -surface.distance);
      if (std::abs(surface.distance) < 1e-6) normals.push_back(surface.n);
    };
    look(surface_of(plane, q));
    for (const Sphere& sphere : spheres) look(surface_of(sphere, q));
    if (scene.world()->active_count() > 1) ++result.several;
    double least = 1;
    for (const Vector3d& a : normals) {
      for (const Vector3d& b : normals) least = std::min(least, a.dot(b));
    }
    if (least < -0.5) ++result.acute;
    const double off = off_cone(normals, q - p);
    if (off > 1e-9) ++result.off_count;
    result.off = std::max(result.off, off);
    ContactState found{.touching = scene.world()->active_count() > 0, .depth = (q - p).norm()};
    found.n_W = found.depth > 0 ? Vector3d((q - p) / found.depth) : Vector3d::UnitX();
    const ContactState& felt = filter.follow(p, found) ? found : filter.felt();
    const Vector3d f_W =
        found.touching ? Vector3d(kStiffness * felt.depth * felt.n_W) : Vector3d(0, 0, 0);
    result.force_off = std::max(result.force_off, (command.f_T_W - f_W).norm());
  }
  result.unsettled = scene.world()->counters().unsettled;
  return result;
}

Found wander_in_all(int scenes, int ticks, double depth_max) {
  Random random(scenes);
  Found all;
  for (int i = 0; i < scenes; ++i) {
    const Found one = wander(random, ticks, depth_max);
    all.several += one.several;
    all.acute += one.acute;
    all.inside = std::max(all.inside, one.inside);
    all.off_count += one.off_count;
    all.off = std::max(all.off, one.off);
    all.force_off = std::max(all.force_off, one.force_off);
    all.unsettled += one.unsettled;
  }
  std::printf(
      "%d ticks, %d with several solids, %d in acute grooves; proxy %.1e m inside, %.1e m off, "
      "more than 1e-9 m in %d; force %.1e N off; %d unsettled\n",
      scenes * ticks, all.several, all.acute, all.inside, all.off, all.off_count, all.force_off,
      static_cast<int>(all.unsettled));
  return all;
}

TEST(WorldCurved, TheProxyRestsAgainstOverlappingSpheresAndAPlane) {
  const int scenes = support::long_form() ? 5000 : 200;
  // As deep as a hand can press: 4 N.
  const Found all = wander_in_all(scenes, 2000, 0.005);
  EXPECT_GT(all.several, scenes * 20);
  EXPECT_GT(all.acute, scenes);
  EXPECT_EQ(all.inside, 0);
  EXPECT_LE(all.off_count, scenes * 2000 / 10'000);
  EXPECT_LE(all.unsettled, static_cast<std::uint64_t>(scenes / 1000));
  if (all.off_count > 0) return;
  EXPECT_LT(all.off, 1e-9 * kSize);
  EXPECT_LT(all.force_off, 1e-6);
}

/// Normals of the surfaces within 1e-6 m of a point, by sampling directions of a shape's distance.
std::vector<Vector3d> normals_near(const Primitive& primitive, const Vector3d& q, bool& inside) {
  std::vector<Vector3d> normals;
  std::visit(
      [&](const auto& shape) {
        if constexpr (requires { shape.kSide; }) {
          inside = inside || shape.inside(q);
          for (std::int32_t face = 0; face <= shape.kSide; ++face) {
            // Just below the face, where it is felt.
            const Vector3d n = shape.on_face(q, face, Vector3d::Zero()).n_W;
            const PrimitivePlace place = shape.on_face(q - 1e-6 * n, face, Vector3d::Zero());
            if (place.depth > 0 && place.depth < 2e-6) normals.push_back(place.n_W);
          }
        } else if constexpr (requires { shape.place(q, q); }) {
          inside = inside || shape.inside(q);
          const PrimitivePlace place = shape.place(q, Vector3d::Zero());
          if (std::abs(place.depth) < 1e-6) normals.push_back(place.n_W);
        }
      },
      primitive);
  return normals;
}

Primitive random_round_shape(Random& random) {
  const Vector3d axis = random.direction();
  Eigen::Matrix3d R;
  R.col(2) = axis;
  R.col(0) = axis.unitOrthogonal();
  R.col(1) = axis.cross(R.col(0));
  const RoundFrame frame{.R_WO = R, .p_WO = random.in_box(0.015)};
  const double radius = random.uniform(0.008, 0.02), half_height = random.uniform(0.008, 0.02);
  switch (static_cast<int>(random.uniform(0, 4))) {
    case 0:
      return Cylinder{frame, radius, half_height};
    case 1:
      return Cone{frame, radius, half_height};
    case 2:
      return Capsule{frame, radius, half_height};
    default:
      return Torus{frame, radius + 0.01, 0.8 * radius};
  }
}

TEST(WorldCurved, TheProxyRestsAgainstTwoRoundShapesThatOverlap) {
  const int scenes = support::long_form() ? 5000 : 200;
  constexpr int kTicks = 2000;
  Random random(scenes);
  int several = 0, touching = 0, inside_count = 0, off_count = 0;
  double off_max = 0;
  for (int i = 0; i < scenes; ++i) {
    const std::array<Primitive, 2> shapes{random_round_shape(random), random_round_shape(random)};
    std::vector<std::unique_ptr<ObjectTouch>> objects;
    for (const Primitive& shape : shapes) {
      objects.push_back(build_primitive_touch(shape, {.spring = {.stiffness = kStiffness}}));
    }
    SceneTouch scene(std::move(objects));
    Vector3d p = 0.1 * random.direction(), target = random.in_box(0.01);
    scene(support::tip_at(p));
    for (int tick = 0; tick < kTicks; ++tick) {
      if (random.uniform(0, 1) < 0.004) target = random.in_box(0.025);
      const Vector3d way = target - p;
      p += std::min(1.0, random.uniform(0, 2e-4) / way.norm()) * way;
      const Vector3d deep = p - scene.world()->proxy();
      if (deep.norm() > 0.003) p -= (1 - 0.003 / deep.norm()) * deep;
      scene(support::tip_at(p));
      const Vector3d q = scene.world()->proxy();
      if (scene.world()->active_count() > 0) ++touching;
      if (scene.world()->active_count() > 1) ++several;
      bool inside = false;
      std::vector<Vector3d> normals = normals_near(shapes[0], q, inside);
      const auto others = normals_near(shapes[1], q, inside);
      normals.insert(normals.end(), others.begin(), others.end());
      if (inside) ++inside_count;
      const double off = off_cone(normals, q - p);
      if (off > 1e-9) ++off_count;
      off_max = std::max(off_max, off);
    }
  }
  std::printf("%d ticks in contact, %d with both; %d inside; %d off the cone, by %.1e m at most\n",
              touching, several, inside_count, off_count, off_max);
  EXPECT_GT(touching, scenes * 200);
  EXPECT_GT(several, scenes * 5);
  EXPECT_EQ(inside_count, 0);
  EXPECT_LE(off_count, scenes * kTicks / 1000);
}

// Half-way through a sphere the proxy may have to travel around it in a tick.
TEST(WorldCurved, TheProxyIsNeverInsideAtAnyDepth) {
  const int scenes = support::long_form() ? 5000 : 200;
  const Found all = wander_in_all(scenes, 2000, 1);
  EXPECT_GT(all.several, scenes * 20);
  EXPECT_EQ(all.inside, 0);
  EXPECT_LE(all.off_count, scenes * 2000 / 1000);
}

}  // namespace
}  // namespace thimble::render
