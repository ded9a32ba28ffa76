// Bodies that meet, against closed forms. Each test names its bound in SI units.

#include "collision/collision_world.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <vector>

#include "support/long_form.h"
#include "support/meeting_bodies.h"
#include "support/random.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;
using support::MeetingBodies;
using support::Random;

constexpr double kTick = 1e-3;
constexpr double kGravity = MeetingBodies::kGravity;

void run(CollisionWorld& world, double duration, double step = kTick) {
  const auto ticks = std::llround(duration / step);
  for (long long i = 0; i < ticks; ++i) world.step(step);
}

const RigidBody& body(const CollisionWorld& world, std::size_t i) {
  return world.motion(i).body();
}

TEST(CollisionWorld, ABodyThatMeetsNothingMovesAsWithoutCollisions) {
  MeetingBodies bodies;
  MotionChoice choice = MeetingBodies::heavy(0.1);
  choice.damping = 0.3;
  choice.angular_damping = 1e-5;
  choice.v_W = {0.1, 0.2, 2};
  choice.omega_W = {3, 20, 1};
  bodies.add_box({0, 0, 0}, {0.03, 0.02, 0.01}, choice);
  bodies.add_box({1, 0, 0}, {0.03, 0.02, 0.01}, choice);
  RigidMotion alone = bodies.motion(0);
  const auto world = bodies.build(kTick);
  for (int i = 0; i < 500; ++i) {
    const Vector3d f(0.01 * (i % 7), -0.02, 0.1);
    const Vector3d p = alone.p_WB() + Vector3d(0.02, 0.01, 0);
    alone.push(f, p);
    world->push(0, 0, f, p);
    alone.step(kTick);
    world->step(kTick);
    ASSERT_EQ(world->motion(0).p_WB(), alone.p_WB()) << i;
    ASSERT_EQ(world->motion(0).R_WB(), alone.R_WB()) << i;
  }
}

TEST(CollisionWorld, TwoBallsReboundAsTheirRestitutionSays) {
  for (const double e : {0.0, 0.3, 1.0}) {
    MeetingBodies bodies;
    MotionChoice fast = MeetingBodies::rigid(0.1);
    fast.v_W = {0.8, 0, 0};
    bodies.add_sphere({0, 0, 0}, 0.02, fast, {.restitution = e});
    bodies.add_sphere({0.1, 0, 0}, 0.02, MeetingBodies::rigid(0.2));  // the larger one counts
    const auto world = bodies.build(kTick);
    run(*world, 0.3);
    EXPECT_NEAR(body(*world, 0).v_WC().x(), 0.8 * (0.1 - e * 0.2) / 0.3, 0.008) << e;
    EXPECT_NEAR(body(*world, 1).v_WC().x(), 0.8 * 0.1 * (1 + e) / 0.3, 0.008) << e;
  }
}

TEST(CollisionWorld, MomentumIsKeptWhateverMeets) {
  Random random(20);
  for (int i = 0; i < 20; ++i) {
    MeetingBodies bodies;
    for (int k = 0; k < 8; ++k) {
      MotionChoice choice = MeetingBodies::rigid(random.uniform(0.02, 0.2));
      const Vector3d p_W = random.in_box(0.08);
      choice.v_W = -3 * p_W + random.in_box(0.1);
      choice.omega_W = random.in_box(10);
      const CollisionChoice collision{.friction = random.uniform(0, 1),
                                      .restitution = random.uniform(0, 1)};
      if (k % 2 == 0) {
        bodies.add_sphere(p_W, random.uniform(0.01, 0.02), choice, collision);
      } else {
        bodies.add_box(p_W, random.in_box(0.005) + Vector3d::Constant(0.012), choice, collision);
      }
    }
    const auto world = bodies.build(kTick);
    Vector3d p = world->momentum_W(), L = world->angular_momentum_W();
    double momentum_off = 0, angular_off = 0;
    for (int tick = 0; tick < 400; ++tick) {
      world->step(kTick);
      momentum_off = std::max(momentum_off, (world->momentum_W() - p).norm());
      angular_off = std::max(angular_off, (world->angular_momentum_W() - L).norm());
      p = world->momentum_W();
      L = world->angular_momentum_W();
    }
    EXPECT_GT(world->solver().counters().contacts, 5u) << i;
    EXPECT_LT(momentum_off, 1e-12) << i;
    // Bullet turns bodies that touch something by an approximation of first order.
    EXPECT_LT(angular_off, 1e-4) << i;
  }
}

TEST(CollisionWorld, ABlockSlidesToRestByItsFriction) {
  std::array<double, 3> off{};
  const std::array<double, 3> steps{2e-3, 1e-3, 5e-4};
  const double way = 0.5 * 0.5 / (2 * 0.3 * kGravity);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    MeetingBodies bodies;
    MotionChoice choice = MeetingBodies::heavy(0.1);
    choice.v_W = {0.5, 0, 0};
    choice.floor = Floor{.n_W = {0, 0, 1}, .height = -0.01, .friction = 0.3};
    bodies.add_box({0, 0, 0}, {0.03, 0.02, 0.01}, choice);
    const auto world = bodies.build(steps[i]);
    run(*world, 0.5, steps[i]);
    off[i] = std::abs(body(*world, 0).p_WC().x() - way);
    EXPECT_LT(body(*world, 0).v_WC().norm(), 1e-6);
  }
  EXPECT_LT(off[1], 0.01 * way);
  EXPECT_LT(off[2], 0.7 * off[0]);
}

TEST(CollisionWorld, FrictionOfAPairIsTheGeometricMean) {
  MeetingBodies bodies;
  MotionChoice choice = MeetingBodies::heavy(0.1);
  choice.v_W = {0.5, 0, 0};
  bodies.add_box({0, 0, 0.01}, {0.03, 0.02, 0.01}, choice, {.friction = 0.9});
  const Primitive table = HalfSpace{.n_W = {0, 0, 1}, .p_WO = {0, 0, 0}};
  bodies.add_fixed({.mesh_W = nullptr, .shape_W = &table}, {.friction = 0.1});
  const auto world = bodies.build(kTick);
  run(*world, 0.5);
  const double way = 0.5 * 0.5 / (2 * 0.3 * kGravity);
  EXPECT_NEAR(body(*world, 0).p_WC().x(), way, 0.02 * way);
}

TEST(CollisionWorld, AStackOfTenBlocksStands) {
  MeetingBodies bodies;
  MotionChoice choice = MeetingBodies::heavy(0.02);
  choice.floor = Floor{.n_W = {0, 0, 1}, .height = 0, .friction = 0.5};
  const auto place = [](int i) { return Vector3d(0, 0, 0.02 * i + 0.01); };
  for (int i = 0; i < 10; ++i) bodies.add_box(place(i), Vector3d::Constant(0.01), choice);
  const auto world = bodies.build(kTick);
  run(*world, 0.5);
  std::vector<Vector3d> settled;
  for (std::size_t i = 0; i < 10; ++i) settled.push_back(body(*world, i).p_WC());
  run(*world, support::long_form() ? 60 : 5);
  double sunk = 0, drift = 0;
  for (std::size_t i = 0; i < 10; ++i) {
    sunk = std::max(sunk, (settled[i] - place(static_cast<int>(i))).norm());
    drift = std::max(drift, (body(*world, i).p_WC() - settled[i]).norm());
  }
  EXPECT_LT(sunk, 1e-4);
  EXPECT_LT(drift, 1e-4);
}

TEST(CollisionWorld, NoBodyPassesThroughAnotherAtTwoMPerS) {
  // Plates 5 mm thick, and a ball of 5 mm; the fixed one is touched as box, hull and mesh.
  for (const CollisionShape shape :
       {CollisionShape::kOwn, CollisionShape::kHull, CollisionShape::kMesh}) {
    for (int i = 0; i < 40; ++i) {
      MeetingBodies bodies;
      MotionChoice choice = MeetingBodies::rigid(0.05);
      choice.v_W = {0, 0, -2};
      choice.omega_W = {i * 1.0, 0, 0};
      const Vector3d p_W(0, 0, 0.03 + 1e-4 * i);
      if (i % 2 == 0) {
        bodies.add_sphere(p_W, 0.0025, choice);
      } else {
        bodies.add_box(p_W, {0.02, 0.02, 0.0025}, choice);
      }
      const TriangleMesh mesh = support::box({0.1, 0.1, 0.0025});
      WedgeBox plate;
      plate.half_sides = {0.1, 0.1, 0.0025};
      const Primitive primitive = plate;
      bodies.add_fixed({&mesh, shape == CollisionShape::kOwn ? &primitive : nullptr},
                       {.shape = shape});
      const auto world = bodies.build(kTick);
      run(*world, 0.2);
      EXPECT_GT(body(*world, 0).p_WC().z(), 0) << i << " shape " << static_cast<int>(shape);
    }
  }
}

TEST(CollisionWorld, TwoPlatesThatFlyAtEachOtherDoNotPass) {
  for (int i = 0; i < 40; ++i) {
    MeetingBodies bodies;
    MotionChoice choice = MeetingBodies::rigid(0.05);
    choice.v_W = {0, 0, -1};
    bodies.add_box({0, 0, 0.03 + 1e-4 * i}, {0.02, 0.02, 0.0025}, choice);
    choice.v_W = {0, 0, 1};
    bodies.add_box({0, 0, -0.03}, {0.02, 0.02, 0.0025}, choice);
    const auto world = bodies.build(kTick);
    run(*world, 0.2);
    EXPECT_GT(body(*world, 0).p_WC().z(), body(*world, 1).p_WC().z()) << i;
  }
}

TEST(CollisionWorld, EnergyNeverGrowsWithoutAHand) {
  const int scenes = support::long_form() ? 1000 : 40;
  Random random(scenes);
  double grown = 0;
  for (int i = 0; i < scenes; ++i) {
    MeetingBodies bodies;
    const auto count = static_cast<int>(random.uniform(2, 12));
    for (int k = 0; k < count; ++k) {
      MotionChoice choice = MeetingBodies::heavy(random.uniform(0.001, 0.2));
      choice.floor = Floor{.n_W = {0, 0, 1}, .height = 0, .friction = random.uniform(0, 1)};
      choice.v_W = random.in_box(0.5);
      choice.omega_W = random.in_box(10);
      // None overlaps another at first.
      const Vector3d p_W = random.in_box(0.01) + Vector3d(0, 0, 0.05 + 0.09 * k);
      const CollisionChoice collision{.friction = random.uniform(0, 1),
                                      .restitution = random.uniform(0, 0.9)};
      if (k % 2 == 0) {
        bodies.add_sphere(p_W, random.uniform(0.005, 0.02), choice, collision);
      } else {
        bodies.add_box(p_W, random.in_box(0.006) + Vector3d::Constant(0.012), choice, collision);
      }
    }
    const auto world = bodies.build(kTick);
    const double first = world->energy_for(0);
    double least = 0;
    for (int tick = 0; tick < 1500; ++tick) {
      world->step(kTick);
      const double now = world->energy() - first;
      ASSERT_TRUE(std::isfinite(now));
      least = std::min(least, now);
      grown = std::max(grown, now - least);
    }
  }
  // Bodies that overlap are moved apart, which may lift them.
  EXPECT_LT(grown, 1e-4);
}

TEST(CollisionWorld, EqualWorldsMoveBitForBit) {
  const auto make = [] {
    Random random(std::uint64_t{5});
    MeetingBodies bodies;
    for (int k = 0; k < 10; ++k) {
      MotionChoice choice = MeetingBodies::heavy(0.05);
      choice.floor = Floor{.n_W = {0, 0, 1}, .height = 0, .friction = 0.5};
      bodies.add_box(random.in_box(0.02) + Vector3d(0, 0, 0.03 * k + 0.03),
                     Vector3d::Constant(0.01), choice, {.restitution = 0.3});
    }
    return bodies.build(kTick);
  };
  const auto a = make(), b = make();
  for (int tick = 0; tick < 2000; ++tick) {
    a->step(kTick);
    b->step(kTick);
  }
  for (std::size_t i = 0; i < 10; ++i) {
    EXPECT_EQ(a->motion(i).p_WB(), b->motion(i).p_WB());
    EXPECT_EQ(a->motion(i).R_WB(), b->motion(i).R_WB());
  }
}

JointChoice hinge_along_y() {
  JointChoice joint;
  joint.kind = JointKind::kHinge;
  joint.axis_W = {0, 1, 0};
  return joint;
}

TEST(CollisionJoints, APendulumSwingsWithItsPeriod) {
  MeetingBodies bodies;
  const Vector3d half(0.005, 0.005, 0.05);
  const int rod = bodies.add_box({0, 0, -0.05}, half, MeetingBodies::heavy(0.1));
  const double inertia = 0.1 * (half.x() * half.x() + half.z() * half.z()) / 3 + 0.1 * 0.05 * 0.05;
  constexpr double kTurning = 0.5;  // rad/s
  bodies.motion(rod).body().set_momentum(0.1 * Vector3d(-0.05 * kTurning, 0, 0),
                                         Vector3d(0, (inertia - 0.1 * 0.05 * 0.05) * kTurning, 0));
  bodies.add_joint(hinge_along_y(), rod);
  const auto world = bodies.build(kTick);
  const double begin = world->energy();
  double first = -1, last = -1, off = 0;
  int crossings = 0;
  for (int i = 0; i < 10000; ++i) {
    const double before = body(*world, 0).p_WC().x();
    world->step(kTick);
    const double now = body(*world, 0).p_WC().x();
    off = std::max(off, world->motion(0).p_WB().norm());
    if (!(before < 0 && now >= 0)) continue;
    last = kTick * (i - before / (now - before));
    if (crossings++ == 0) first = last;
  }
  const double length = inertia / (0.1 * 0.05);
  const double slow = 2 * M_PI * std::sqrt(length / kGravity);
  const double amplitude = kTurning * std::sqrt(length / kGravity);
  EXPECT_NEAR((last - first) / (crossings - 1), slow * (1 + amplitude * amplitude / 16),
              1e-4 * slow);
  EXPECT_LT(off, 1e-6);
  EXPECT_LT(std::abs(world->energy() - begin), 0.05 * inertia * kTurning * kTurning / 2);
}

TEST(CollisionJoints, AHingeEndsAtItsLimits) {
  MeetingBodies bodies;
  const int rod = bodies.add_box({0, 0, 0.05}, {0.005, 0.005, 0.05}, MeetingBodies::heavy(0.1));
  JointChoice joint = hinge_along_y();
  joint.limits.emplace(-0.5, 0.8);
  bodies.add_joint(joint, rod);
  for (const double push : {0.1, -0.1}) {
    const auto world = bodies.build(kTick);
    for (int i = 0; i < 3000; ++i) {
      world->push(0, 0, {push, 0, 0}, body(*world, 0).p_WC());
      world->step(kTick);
    }
    const Vector3d up = world->motion(0).R_WB().col(2);
    EXPECT_NEAR(std::atan2(up.x(), up.z()), push > 0 ? 0.8 : -0.5, 0.01);
  }
}

TEST(CollisionJoints, FrictionOfAHingeHoldsUpToItsTorque) {
  for (const double torque : {0.004, 0.006}) {  // N m; a push of 0.05 N at 0.1 m turns by 0.005
    MeetingBodies bodies;
    const int rod = bodies.add_box({0, 0, 0.05}, {0.005, 0.005, 0.05}, MeetingBodies::rigid(0.1));
    JointChoice joint = hinge_along_y();
    joint.friction = torque;
    bodies.add_joint(joint, rod);
    const auto world = bodies.build(kTick);
    for (int i = 0; i < 300; ++i) {
      world->push(0, 0, {0.05, 0, 0},
                  world->motion(0).p_WB() + world->motion(0).R_WB() * Vector3d(0, 0, 0.1));
      world->step(kTick);
    }
    const double turned = std::abs(std::asin(world->motion(0).R_WB().col(2).x()));
    if (torque > 0.005) {
      EXPECT_LT(turned, 1e-4);
    } else {
      EXPECT_GT(turned, 0.05);
    }
  }
}

TEST(CollisionJoints, AMotorTurnsAtItsSpeedInTheNamedSense) {
  for (const double speed : {2.0, -2.0}) {
    MeetingBodies bodies;
    const int rod = bodies.add_box({0, 0, 0.05}, {0.005, 0.005, 0.05}, MeetingBodies::rigid(0.1));
    JointChoice joint = hinge_along_y();
    joint.speed = speed;
    joint.motor_max = 0.1;
    bodies.add_joint(joint, rod);
    const auto world = bodies.build(kTick);
    run(*world, 0.5);
    EXPECT_NEAR(body(*world, 0).omega_W().y(), speed, 0.01);
  }
}

TEST(CollisionJoints, ASliderMovesAlongItsAxisWithinItsLimits) {
  MeetingBodies bodies;
  const int drawer = bodies.add_box({0, 0, 0}, {0.03, 0.02, 0.01}, MeetingBodies::heavy(0.1));
  JointChoice joint;
  joint.kind = JointKind::kSlider;
  joint.axis_W = {1, 0, 0};
  joint.limits.emplace(-0.01, 0.04);
  joint.friction = 0.1;
  bodies.add_joint(joint, drawer);
  for (const double push : {0.05, 0.3, -0.3}) {
    const auto world = bodies.build(kTick);
    for (int i = 0; i < 2000; ++i) {
      world->push(0, 0, {push, 0.2, 0}, body(*world, 0).p_WC() + Vector3d(0, 0.01, 0.01));
      world->step(kTick);
    }
    const Vector3d p = body(*world, 0).p_WC();
    EXPECT_NEAR(p.x(), push == 0.05 ? 0 : push > 0 ? 0.04 : -0.01, 3e-4) << push;
    EXPECT_LT(std::hypot(p.y(), p.z()), 1e-4);
    EXPECT_LT((world->motion(0).R_WB() - Eigen::Matrix3d::Identity()).norm(), 1e-3);
  }
}

TEST(CollisionJoints, ASliderMotorMovesAtItsSpeedInTheNamedSense) {
  for (const double speed : {0.05, -0.05}) {
    MeetingBodies bodies;
    const int drawer = bodies.add_box({0, 0, 0}, {0.03, 0.02, 0.01}, MeetingBodies::rigid(0.1));
    JointChoice joint;
    joint.kind = JointKind::kSlider;
    joint.axis_W = {0, 0.6, 0.8};
    joint.speed = speed;
    joint.motor_max = 1;
    bodies.add_joint(joint, drawer);
    const auto world = bodies.build(kTick);
    run(*world, 0.5);
    EXPECT_LT((body(*world, 0).v_WC() - speed * Vector3d(0, 0.6, 0.8)).norm(), 0.001);
  }
}

TEST(CollisionJoints, ABallJointHoldsItsPointAndAFixedOneAll) {
  for (const JointKind kind : {JointKind::kBall, JointKind::kFixed}) {
    MeetingBodies bodies;
    const int a = bodies.add_box({0, 0, 0}, {0.02, 0.02, 0.02}, MeetingBodies::heavy(0.1));
    const int b = bodies.add_box({0.05, 0, 0}, {0.02, 0.02, 0.02}, MeetingBodies::heavy(0.1));
    JointChoice joint;
    joint.kind = kind;
    joint.p_W = {0.025, 0, 0};
    bodies.add_joint(joint, a, b);
    joint.p_W = {-0.02, 0, 0};
    bodies.add_joint(joint, a);
    const auto world = bodies.build(kTick);
    double off = 0, turned = 0;
    for (int i = 0; i < 2000; ++i) {
      world->step(kTick);
      const auto at = [&](std::size_t k, const Vector3d& p) -> Vector3d {
        return world->motion(k).p_WB() + world->motion(k).R_WB() * p;
      };
      off = std::max(off, (at(0, {0.025, 0, 0}) - at(1, {0.025, 0, 0})).norm());
      off = std::max(off, (at(0, {-0.02, 0, 0}) - Vector3d(-0.02, 0, 0)).norm());
      turned = std::max(turned, (world->motion(1).R_WB() - Eigen::Matrix3d::Identity()).norm());
    }
    EXPECT_LT(off, 1e-4);
    if (kind == JointKind::kFixed) {
      EXPECT_LT(turned, 1e-3);
    } else {
      EXPECT_GT(turned, 0.5);
    }
  }
}

TEST(CollisionJoints, ASpringHasItsFrequencyAndKeepsMomentum) {
  MeetingBodies bodies;
  MotionChoice choice = MeetingBodies::rigid(0.1);
  const int a = bodies.add_sphere({0, 0, 0}, 0.01, choice);
  choice.v_W = {0.1, 0, 0};
  const int b = bodies.add_sphere({0.1, 0, 0}, 0.01, choice);
  JointChoice joint;
  joint.kind = JointKind::kSpring;
  joint.p_W = {0, 0, 0};
  joint.p_end_W = {0.1, 0, 0};
  joint.stiffness = 50;
  bodies.add_joint(joint, a, b);
  const auto world = bodies.build(kTick);
  const Vector3d p = world->momentum_W(), L = world->angular_momentum_W();
  double last = -1, first = -1;
  int crossings = 0;
  double before = 0;
  for (int i = 0; i < 2000; ++i) {
    world->step(kTick);
    const double now = body(*world, 1).p_WC().x() - body(*world, 0).p_WC().x() - 0.1;
    if (before < 0 && now >= 0) {
      last = kTick * (i - before / (now - before));
      if (crossings++ == 0) first = last;
    }
    before = now;
  }
  const double period = 2 * M_PI / std::sqrt(50 * 2 / 0.1);
  EXPECT_NEAR((last - first) / (crossings - 1), period, 0.002 * period);
  EXPECT_LT((world->momentum_W() - p).norm(), 1e-15);
  EXPECT_LT((world->angular_momentum_W() - L).norm(), 1e-15);
}

}  // namespace
}  // namespace thimble::render
