// A tip that is a ball, on solids of which the sum with a ball is known in closed form.

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "ball/box_ball.h"
#include "support/box_union.h"
#include "support/heap_guard.h"
#include "support/meshes/concave_solids.h"
#include "support/random.h"
#include "support/tip_at.h"
#include "thimble/render/build_object_touch.h"
#include "thimble/render/build_primitive_touch.h"
#include "thimble/render/scene_touch.h"
#include "world/active_planes.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;
using support::Random;
using support::SolidBlock;
using support::tip_at;

constexpr double kStiffness = 800;
SurfaceChoice surface() {
  return {.spring = {.stiffness = kStiffness}};
}

std::unique_ptr<ObjectTouch> mesh_touch(const TriangleMesh& mesh, double radius) {
  return build_object_touch(mesh, {.tip_radius = radius}, surface()).value();
}

/// A slot of the given width and 20 mm depth in a block with its top at z = 0.
TriangleMesh slot(double width) {
  const double half = width / 2;
  TriangleMesh mesh;
  const auto add = [&mesh](const SolidBlock& block) {
    const auto first = static_cast<std::int32_t>(mesh.vertices.size());
    const TriangleMesh one = block.mesh();
    mesh.vertices.insert(mesh.vertices.end(), one.vertices.begin(), one.vertices.end());
    for (const auto& [a, b, c] : one.triangles) {
      mesh.triangles.push_back({first + a, first + b, first + c});
    }
  };
  add({.centre = {-half - 0.01, 0, -0.02}, .half = {0.01, 0.03, 0.02}});
  add({.centre = {half + 0.01, 0, -0.02}, .half = {0.01, 0.03, 0.02}});
  add({.centre = {0, 0, -0.03}, .half = {half, 0.03, 0.01}});
  return mesh;
}

TEST(BallShapes, ABallUnderABallIsALargerBall) {
  const double r = 0.02, R = 0.004;
  const Sphere sphere{.p_WO = {0.01, -0.02, 0.005}, .radius = r};
  const auto touch = build_primitive_touch(sphere, surface(), R);
  const auto larger =
      build_primitive_touch(Sphere{.p_WO = sphere.p_WO, .radius = r + R}, surface());
  Random random(700);
  Vector3d p = sphere.p_WO + Vector3d(0, 0, 0.05), target = p;
  int touching = 0;
  for (int i = 0; i < 20'000; ++i) {
    if (i % 100 == 0) target = sphere.p_WO + random.in_box(0.03);
    p += 3e-4 * (target - p).normalized();
    const driver::ForceCommand a = touch->update(tip_at(p)), b = larger->update(tip_at(p));
    ASSERT_LT((a.f_T_W - b.f_T_W).norm(), 1e-9);
    touching += a.touch.in_contact ? 1 : 0;
  }
  EXPECT_GT(touching, 5000);
}

/// A box is rounded on faces, edges and corners. Inside of its rim, the proxy is in closed form.
void expect_rounded_box(ObjectTouch& touch, const SolidBlock& block, double R) {
  Random random(701);
  for (int k = 0; k < 4000; ++k) {
    // A point on the rounded box, its normal, and a tip below it by less than R.
    const Vector3d n_O = random.direction();
    Vector3d c_O = block.half.cwiseProduct(n_O.cwiseSign());
    Vector3d n = n_O;
    const int kind = k % 3;  // corner, edge, face
    if (kind > 0) {
      c_O[k / 3 % 3] *= random.uniform(-0.99, 0.99);
      n[k / 3 % 3] = 0;
    }
    if (kind > 1) {
      c_O[(k / 3 + 1) % 3] *= random.uniform(-0.99, 0.99);
      n[(k / 3 + 1) % 3] = 0;
    }
    n.normalize();
    const double depth = random.uniform(0.01, 0.45) * R;
    const Vector3d n_W = block.R * n;
    const Vector3d q = block.centre + block.R * (c_O + R * n);
    const Vector3d p = q - depth * n_W;
    touch.update(tip_at(Vector3d::Constant(std::numeric_limits<double>::quiet_NaN())));
    touch.update(tip_at(q + 0.01 * n_W));
    // Obliquely, so that the ball has to slide to its place.
    touch.update(tip_at(p + 0.2 * R * random.direction()));
    driver::ForceCommand last;
    for (int tick = 0; tick < 6; ++tick) last = touch.update(tip_at(p));
    ASSERT_LT((last.f_T_W - kStiffness * depth * n_W).norm(), 1e-9 * kStiffness) << k;
    ASSERT_LT((last.touch.p_WP - q).norm(), 1e-9) << k;
  }
}

SolidBlock turned_block() {
  return {.centre = {0.01, 0.003, -0.02},
          .half = {0.02, 0.012, 0.017},
          .R = Eigen::AngleAxisd(0.7, Vector3d(1, 2, -1).normalized()).toRotationMatrix()};
}

TEST(BallShapes, ABoxWithoutAMeshIsRounded) {
  const SolidBlock block = turned_block();
  EntryFaceBox box;
  box.R_WO = block.R;
  box.p_WO = block.centre;
  box.half_sides = block.half;
  const auto touch = build_primitive_touch(box, surface(), 0.003);
  expect_rounded_box(*touch, block, 0.003);
}

TEST(BallShapes, ABoxOfTrianglesIsRounded) {
  const SolidBlock block = turned_block();
  expect_rounded_box(*mesh_touch(block.mesh(), 0.003), block, 0.003);
}

TEST(BallShapes, AGrooveKeepsTheBallByItsAngle) {
  for (const double R : {0.0005, 0.003}) {
    for (const double half_angle : {0.2, 0.6, 1.0, 1.4}) {
      const double rise = std::numbers::pi / 2 - half_angle;
      const TriangleMesh mesh =
          support::groove(rise, rise, 0.03, 0.03, {-0.03, -0.01, 0.0005, 0.01, 0.03}).mesh;
      const auto touch = mesh_touch(mesh, R);
      const double height = R / std::sin(half_angle);
      touch->update(tip_at({0, 0, 0.05}));
      for (int i = 0; i <= 2000; ++i) {
        const double s = 1e-3 * i;
        // Swings between the walls, and down past the bottom.
        const Vector3d p(0.3 * R * std::sin(7 * s), 0.012 * std::sin(3 * s),
                         std::max(0.02 - 0.03 * s, -0.002));
        const driver::ForceCommand command = touch->update(tip_at(p));
        const Vector3d left(std::sin(rise), 0, std::cos(rise)),
            right(-std::sin(rise), 0, std::cos(rise));
        const std::vector<ActivePlane> planes{{left, R}, {right, R}};
        const Vector3d d = push_out(planes, p, 0, 1e-16).d;
        ASSERT_LT((command.f_T_W - kStiffness * d).norm(), 1e-9 * kStiffness) << R << half_angle;
      }
      const driver::ForceCommand rest = touch->update(tip_at({0, 0.001, -0.002}));
      EXPECT_NEAR(rest.touch.p_WP.z(), height, 1e-9);
      EXPECT_NEAR(rest.touch.p_WP.x(), 0, 1e-9);
    }
  }
}

TEST(BallShapes, ANarrowSlotIsNotEnteredAndAWideOneIs) {
  const double R = 0.003;
  for (const double width : {2 * R - 1e-6, 2 * R + 1e-6}) {
    const auto touch = mesh_touch(slot(width), R);
    driver::ForceCommand last;
    for (int i = 0; i <= 3000; ++i) {
      last = touch->update(tip_at({2e-4 * std::sin(0.1 * i), 0.001, 0.01 - 1e-5 * i}));
    }
    if (width < 2 * R) {
      // On both rims.
      const double half = width / 2;
      EXPECT_NEAR(last.touch.p_WP.z(), std::sqrt(R * R - half * half), 1e-9);
    } else {
      EXPECT_NEAR(last.touch.p_WP.z(), -0.02 + R, 1e-9);
      EXPECT_NEAR(last.touch.p_WP.x(), 0, 2e-6);
    }
  }
}

TEST(BallShapes, AThinPlateIsNotPassedAtTwoMetresPerSecond) {
  const TriangleMesh plate = SolidBlock{.half = {0.05, 0.05, 0.00005}}.mesh();
  Random random(702);
  for (const double R : {1e-5, 0.001, 0.008}) {
    const auto touch = mesh_touch(plate, R);
    for (int k = 0; k < 100; ++k) {
      Vector3d p(random.uniform(-0.02, 0.02), random.uniform(-0.02, 0.02), 0.03);
      const Vector3d target(random.uniform(-0.02, 0.02), random.uniform(-0.02, 0.02), -0.03);
      const Vector3d step = 2e-3 * (target - p).normalized();
      touch->update(tip_at({0, 0, 1}));
      touch->update(tip_at(p));
      driver::ForceCommand last;
      while (p.z() > -0.03) {
        p += step;
        last = touch->update(tip_at(p));
        ASSERT_EQ(last.touch.in_contact, p.z() < 0.00005 + R);
      }
      ASSERT_NEAR(last.touch.depth, 0.00005 + R - p.z(), 1e-9);
    }
  }
}

/// Moves a tip about a shape and a solid that is known to be its sum with the ball, and expects the
/// same forces.
template <class Shape>
void expect_like(const Shape& shape, double R, const Primitive& sum, double size, int seed) {
  const auto touch = build_primitive_touch(shape, surface(), R);
  const auto whole = build_primitive_touch(sum, surface());
  Random random(seed);
  Vector3d p = shape.p_WO + Vector3d(0, 0, 4 * size), target = p;
  int touching = 0;
  for (int i = 0; i < 20'000; ++i) {
    if (i % 100 == 0) target = shape.p_WO + random.in_box(size);
    p += 3e-4 * (target - p).normalized();
    const driver::ForceCommand a = touch->update(tip_at(p)), b = whole->update(tip_at(p));
    ASSERT_LT((a.f_T_W - b.f_T_W).norm(), 1e-9);
    touching += a.touch.in_contact ? 1 : 0;
  }
  EXPECT_GT(touching, 3000);
}

Eigen::Matrix3d turned() {
  return Eigen::AngleAxisd(0.8, Vector3d(1, -2, 1).normalized()).toRotationMatrix();
}

TEST(BallShapes, ACapsuleOrATorusUnderABallIsThicker) {
  const double R = 0.003;
  Capsule capsule;
  capsule.R_WO = turned();
  capsule.p_WO = {0.01, 0, -0.02};
  capsule.radius = 0.008;
  capsule.half_height = 0.015;
  Capsule thick = capsule;
  thick.radius += R;
  expect_like(capsule, R, thick, 0.03, 703);
  Torus torus;
  torus.R_WO = turned();
  torus.p_WO = {0.01, 0, -0.02};
  torus.radius = 0.025;
  torus.tube = 0.006;
  Torus fat = torus;
  fat.tube += R;
  expect_like(torus, R, fat, 0.04, 704);
}

/// Where a ball rests on a solid of revolution, in closed form, and the way out from there.
struct RestOnRound {
  Vector3d q_O, n_O;
};

/// Puts a tip `depth` (m) below each of the places, and expects the ball to come to rest there.
template <class Shape>
void expect_rests(const Shape& shape, double R, double depth_max, Random& random,
                  const std::function<RestOnRound()>& draw) {
  const auto touch = build_primitive_touch(shape, surface(), R);
  for (int k = 0; k < 3000; ++k) {
    const RestOnRound rest = draw();
    const double depth = random.uniform(0.01, 0.45) * depth_max;
    const Vector3d n = shape.R_WO * rest.n_O, q = shape.p_WO + shape.R_WO * rest.q_O;
    const Vector3d p = q - depth * n;
    touch->update(tip_at(Vector3d::Constant(std::numeric_limits<double>::quiet_NaN())));
    touch->update(tip_at(q + 0.01 * n));
    // Obliquely, so that the ball has to slide to its place.
    touch->update(tip_at(p + 0.2 * depth_max * random.direction()));
    driver::ForceCommand last;
    for (int tick = 0; tick < 6; ++tick) last = touch->update(tip_at(p));
    ASSERT_LT((last.f_T_W - kStiffness * depth * n).norm(), 1e-9 * kStiffness) << k;
    ASSERT_LT((last.touch.p_WP - q).norm(), 1e-9) << k;
  }
}

TEST(BallShapes, ACylinderIsRoundedAtItsRims) {
  const double R = 0.003;
  Cylinder cylinder;
  cylinder.R_WO = turned();
  cylinder.p_WO = {0.01, -0.005, 0.02};
  cylinder.radius = 0.012;
  cylinder.half_height = 0.02;
  Random random(705);
  int kind = 0;
  expect_rests(cylinder, R, R, random, [&]() -> RestOnRound {
    const double angle = random.uniform(0, 2 * std::numbers::pi), up = kind % 2 ? 1 : -1;
    const Vector3d out(std::cos(angle), std::sin(angle), 0), axis(0, 0, up);
    Vector3d c, n;
    switch (++kind % 3) {
      case 0:
        c = random.uniform(0, 0.7) * 0.012 * out + 0.02 * axis;
        n = axis;
        break;
      case 1:
        c = 0.012 * out + random.uniform(0, 0.9) * 0.02 * axis;
        n = out;
        break;
      default: {
        const double turn = random.uniform(0.1, 1.4);
        c = 0.012 * out + 0.02 * axis;
        n = std::cos(turn) * out + std::sin(turn) * axis;
      }
    }
    return {.q_O = c + R * n, .n_O = n};
  });
}

TEST(BallShapes, AConeIsRoundedAtItsRimAndItsTip) {
  const double R = 0.003;
  Cone cone;
  cone.R_WO = turned();
  cone.p_WO = {0.01, -0.005, 0.02};
  cone.radius = 0.015;
  cone.half_height = 0.02;
  Random random(706);
  int kind = 0;
  const double steep = std::atan2(cone.sine(), cone.cosine());
  expect_rests(cone, R, R, random, [&]() -> RestOnRound {
    const double angle = random.uniform(0, 2 * std::numbers::pi);
    const Vector3d out(std::cos(angle), std::sin(angle), 0), axis(0, 0, 1);
    Vector3d c, n;
    const auto turned_by = [&](double turn) {
      return Vector3d(std::cos(turn) * out + std::sin(turn) * axis);
    };
    switch (++kind % 4) {
      case 0:  // base
        c = random.uniform(0, 0.7) * 0.015 * out - 0.02 * axis;
        n = -axis;
        break;
      case 1: {  // side
        const double share = random.uniform(0.15, 0.85);
        c = (1 - share) * 0.015 * out + (2 * share - 1) * 0.02 * axis;
        n = turned_by(steep);
        break;
      }
      case 2:  // rim
        c = 0.015 * out - 0.02 * axis;
        n = turned_by(random.uniform(-1.4, steep - 0.15));
        break;
      default:  // tip
        c = 0.02 * axis;
        n = turned_by(random.uniform(steep + 0.15, std::numbers::pi / 2));
    }
    return {.q_O = c + R * n, .n_O = n};
  });
}

TEST(BallShapes, ANarrowHoleOfATorusCarriesTheBallOnItsAxis) {
  Torus torus;
  torus.radius = 0.02;
  torus.tube = 0.01;
  const double R = 0.012, height = std::sqrt(0.022 * 0.022 - 0.02 * 0.02);
  for (const double side : {1.0, -1.0}) {
    const auto touch = build_primitive_touch(torus, surface(), R);
    touch->update(tip_at({0, 0, 0.05 * side}));
    driver::ForceCommand last;
    Vector3d before = Vector3d::Zero();
    for (int i = 0; i <= 3000; ++i) {
      const double s = 1e-3 * i;
      const Vector3d p(0.003 * std::sin(9 * s), 0.003 * std::sin(7 * s),
                       side * std::max(-0.001, 0.02 - 0.02 * s));
      last = touch->update(tip_at(p));
      ASSERT_LT((last.f_T_W - before).norm(), 5 * kStiffness * 1e-4) << i;
      before = last.f_T_W;
    }
    EXPECT_LT((last.touch.p_WP - Vector3d(0, 0, side * height)).norm(), 1e-9);
  }
}

TEST(BallShapes, ATickAllocatesNothingAndNanEndsTheContact) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<std::unique_ptr<ObjectTouch>> touches;
  touches.push_back(mesh_touch(support::icosphere(3, 0.02), 0.004));
  touches.push_back(build_primitive_touch(Sphere{.radius = 0.02}, surface(), 0.004));
  EntryFaceBox box;
  box.half_sides = {0.02, 0.02, 0.02};
  touches.push_back(build_primitive_touch(box, surface(), 0.004));
  Cylinder cylinder;
  cylinder.radius = cylinder.half_height = 0.02;
  touches.push_back(build_primitive_touch(cylinder, surface(), 0.004));
  for (const auto& touch : touches) {
    driver::ForceCommand last;
    EXPECT_EQ(support::heap_calls_of([&] {
                for (int i = 0; i < 3000; ++i) {
                  const double s = 2e-3 * i;
                  last = touch->update(tip_at(
                      {0.01 * std::sin(s), 0.01 * std::cos(s), std::max(0.015, 0.04 - 0.001 * i)}));
                }
              }),
              0);
    EXPECT_GT(last.f_T_W.norm(), 0.1);
    EXPECT_EQ(touch->update(tip_at({nan, 0, 0})).f_T_W, Vector3d::Zero());
    EXPECT_EQ(touch->update(tip_at({0, 0, 1e300})).f_T_W, Vector3d::Zero());
    // A tip that is inside on the first tick feels nothing until it has been outside.
    EXPECT_EQ(touch->update(tip_at({0, 0, 0.0215})).f_T_W, Vector3d::Zero());
    EXPECT_EQ(touch->update(tip_at({0, 0, 0.0205})).f_T_W, Vector3d::Zero());
    EXPECT_EQ(touch->update(tip_at({0, 0, 0.05})).f_T_W, Vector3d::Zero());
    EXPECT_GT(touch->update(tip_at({0, 0, 0.0205})).f_T_W.norm(), 0.1);
  }
}

TEST(BallShapes, WhatDeformsIsRefused) {
  SurfaceChoice soft = surface();
  soft.dent.emplace();
  const auto refused = build_object_touch(support::icosphere(2, 0.02), {.tip_radius = 0.004}, soft);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("Remove"), std::string::npos);
  for (const double radius : {-0.001, 2.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_FALSE(
        build_object_touch(support::icosphere(2, 0.02), {.tip_radius = radius}, surface()));
  }
}

TEST(BallShapes, ABoxMovesItsClosestPointAsItsPartSays) {
  Random random(7);
  const Box box{.R_WO = Eigen::AngleAxisd(0.6, Vector3d(1, 2, 3).normalized()).toRotationMatrix(),
                .p_WO = {0.01, 0, 0.02},
                .half_sides = {0.03, 0.02, 0.01}};
  const BoxBall ball(box, 0.005);
  constexpr double kStep = 1e-7;  // m
  std::array<int, 3> found{};
  for (int i = 0; i < 300; ++i) {
    const Vector3d q = box.p_WO + random.in_box(0.05);
    if (box.inside(q)) continue;
    const BallFeature part = ball.feature(0, q);
    ++found.at(static_cast<std::size_t>(part.kind));
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3d step = kStep * Vector3d::Unit(axis);
      const Vector3d moved =
          (ball.feature(0, q + step).p_W - ball.feature(0, q - step).p_W) / (2 * kStep);
      EXPECT_LT((part.slide().col(axis) - moved).norm(), 1e-7) << i;
    }
  }
  for (const int count : found) EXPECT_GT(count, 20);
}

}  // namespace
}  // namespace thimble::render
