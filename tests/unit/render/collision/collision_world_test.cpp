// Bodies that meet, against closed forms. Each test names its bound in SI units.

#include "collision/collision_world.h"

#include <gtest/gtest.h>

#include <LinearMath/btAlignedAllocator.h>
#include <Eigen/Core>
#include <Eigen/Geometry>

#include <LinearMath/btAlignedAllocator.h>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "support/long_form.h"
#include "support/meeting_bodies.h"
#include "support/meshes/made_solids.h"
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
    // Friction acts on both bodies, also before their surfaces meet.
    EXPECT_LT(angular_off, 5e-5) << i;
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
  int growing = 0;
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
    double least = 0, most = 0;
    for (int tick = 0; tick < 1500; ++tick) {
      world->step(kTick);
      const double now = world->energy() - first;
      ASSERT_TRUE(std::isfinite(now));
      least = std::min(least, now);
      most = std::max(most, now - least);
    }
    grown = std::max(grown, most);
    if (most > 1e-6) ++growing;
  }
  // Bodies that overlap are moved apart, which may lift them.
  // Most scenes grow by less than 1e-6 J.
  EXPECT_LT(grown, 1e-4);
  EXPECT_LE(growing, 0.1 * scenes);
}

TEST(CollisionWorld, StepsOfSeveralTicksGiveTheSameMotion) {
  const double way = 0.5 * 0.5 / (2 * 0.3 * kGravity);
  for (const std::size_t every : {2u, 4u, 8u}) {
    MeetingBodies balls;
    balls.quality().every = every;
    MotionChoice fast = MeetingBodies::rigid(0.1);
    fast.v_W = {0.8, 0, 0};
    balls.add_sphere({0, 0, 0}, 0.02, fast, {.restitution = 0.5});
    balls.add_sphere({0.1, 0, 0}, 0.02, MeetingBodies::rigid(0.2));
    const auto impact = balls.build(kTick);
    run(*impact, 0.3);
    EXPECT_NEAR(body(*impact, 0).v_WC().x(), 0, 0.008) << every;
    EXPECT_NEAR(body(*impact, 1).v_WC().x(), 0.4, 0.008) << every;

    MeetingBodies block;
    block.quality().every = every;
    MotionChoice choice = MeetingBodies::heavy(0.1);
    choice.v_W = {0.5, 0, 0};
    choice.floor = Floor{.n_W = {0, 0, 1}, .height = -0.01, .friction = 0.3};
    block.add_box({0, 0, 0}, {0.03, 0.02, 0.01}, choice);
    const auto slide = block.build(kTick);
    run(*slide, 0.5);
    EXPECT_NEAR(body(*slide, 0).p_WC().x(), way, 0.01 * static_cast<double>(every) * way) << every;
    EXPECT_LT(body(*slide, 0).v_WC().norm(), 1e-6) << every;
  }
}

TEST(CollisionWorld, BetweenTwoStepsAPushActsInItsTick) {
  MeetingBodies bodies;
  bodies.quality().every = 8;
  MotionChoice choice = MeetingBodies::rigid(0.1);
  bodies.add_box({0, 0, 0}, Vector3d::Constant(0.01), choice);
  bodies.add_box({0.02, 0, 0}, Vector3d::Constant(0.01), choice);
  const auto world = bodies.build(kTick);
  Vector3d impulse(0, 0, 0), turn(0, 0, 0);
  for (int i = 0; i < 40; ++i) {
    // Presses the first block against the second, and lifts it in a few ticks.
    const Vector3d f(0.5, 0, i % 8 == 3 ? 0.4 : 0), p = body(*world, 0).p_WC();
    const double before = body(*world, 0).v_WC().z();
    world->push(0, 0, f, p);
    world->step(kTick);
    impulse += kTick * f;
    EXPECT_LT((world->momentum_W() - impulse).norm(), i % 8 == 7 ? 1e-12 : 1) << i;
    if (i % 8 == 3) {
      // Less the mean of the last eight ticks, which the solver has given it before.
      const double mean = i < 8 ? 0 : 0.4 / 8;
      EXPECT_NEAR(body(*world, 0).v_WC().z() - before, (0.4 - mean) * kTick / 0.1, 1e-9) << i;
    }
  }
  EXPECT_GT(world->solver().counters().contacts, 4u);
  EXPECT_EQ(world->solver().counters().steps, 5u);
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

/// Returns the mesh of a solid of revolution about y through a point: its outline of radii and
/// heights. Only its mass is used.
TriangleMesh lying(const std::vector<std::pair<double, double>>& outline, const Vector3d& p_W) {
  TriangleMesh mesh = support::turned(outline, 64);
  for (Vector3d& p : mesh.vertices) p = p_W + Vector3d(p.x(), -p.z(), p.y());
  return mesh;
}

/// Adds a cylinder that lies along y on a table at z = 0, at rest or rolling along x.
int add_lying_cylinder(MeetingBodies& bodies, double speed) {
  Cylinder shape;
  shape.radius = 0.01;
  shape.half_height = 0.015;
  shape.p_WO = {0, 0, 0.01};
  shape.R_WO = Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitX()).toRotationMatrix();
  MotionChoice choice = MeetingBodies::heavy(0.1);
  choice.v_W = {speed, 0, 0};
  choice.omega_W = {0, speed / shape.radius, 0};
  return bodies.add(lying({{0.01, 0.015}, {0.01, -0.015}}, shape.p_WO), choice, {},
                    Primitive(shape));
}

TEST(CollisionWorld, ACylinderRollsAtItsSpeedAndRestsWhereItLies) {
  for (const bool on_box : {false, true}) {
    for (const double speed : {0.0, 0.002, 0.3}) {
      MeetingBodies bodies;
      add_lying_cylinder(bodies, speed);
      const Primitive table = HalfSpace{.n_W = {0, 0, 1}, .p_WO = {0, 0, 0}};
      WedgeBox slab;
      slab.half_sides = {2, 0.1, 0.01};
      slab.p_WO = {0, 0, -0.01};
      const Primitive box = slab;
      bodies.add_fixed({.mesh_W = nullptr, .shape_W = on_box ? &box : &table});
      const auto world = bodies.build(kTick);
      run(*world, 3);
      EXPECT_NEAR(body(*world, 0).v_WC().x(), speed, 0.01 * speed + 1e-6) << on_box;
      EXPECT_NEAR(body(*world, 0).p_WC().z(), 0.01, 2e-5) << on_box << " " << speed;
    }
  }
}

TEST(CollisionWorld, FrictionIsEqualInAllDirections) {
  const double way = 1.0 / (2 * 0.3 * kGravity);
  for (const double angle : {0.0, 0.26, M_PI / 4}) {
    MeetingBodies bodies;
    MotionChoice choice = MeetingBodies::heavy(0.1);
    const Vector3d u(std::cos(angle), std::sin(angle), 0);
    choice.v_W = u;
    choice.floor = Floor{.n_W = {0, 0, 1}, .height = -0.005, .friction = 0.3};
    bodies.add_box({0, 0, 0}, {0.015, 0.015, 0.005}, choice);
    const auto world = bodies.build(kTick);
    run(*world, 0.6);
    EXPECT_LT((body(*world, 0).p_WC() - way * u).norm(), 0.02 * way) << angle;
  }
}

TEST(CollisionWorld, ABlockSlipsBeyondTheAngleOfFriction) {
  for (const double angle : {0.25, 0.35}) {  // friction 0.3 holds up to 0.291
    for (const double turn : {0.0, M_PI / 4}) {
      MeetingBodies bodies;
      MotionChoice choice = MeetingBodies::rigid(0.1);
      const Vector3d down(std::cos(turn), std::sin(turn), 0);
      choice.gravity_W = kGravity * (std::sin(angle) * down - std::cos(angle) * Vector3d::UnitZ());
      choice.floor = Floor{.n_W = {0, 0, 1}, .height = -0.005, .friction = 0.3};
      bodies.add_box({0, 0, 0}, {0.015, 0.015, 0.005}, choice);
      const auto world = bodies.build(kTick);
      run(*world, 0.5);
      const double slipped = body(*world, 0).p_WC().dot(down);
      const double way = kGravity * (std::sin(angle) - 0.3 * std::cos(angle)) * 0.5 * 0.5 / 2;
      if (angle < 0.291) {
        EXPECT_LT(slipped, 1e-5) << turn;
      } else {
        EXPECT_NEAR(slipped, way, 0.02 * way) << turn;
      }
    }
  }
}

TEST(CollisionWorld, APushBesideTheMiddleDoesNotMakeABlockCreep) {
  MeetingBodies bodies;
  bodies.add_box({0, 0, 0.01}, Vector3d::Constant(0.01), MeetingBodies::heavy(0.01));
  const Primitive table = HalfSpace{.n_W = {0, 0, 1}, .p_WO = {0, 0, 0}};
  bodies.add_fixed({.mesh_W = nullptr, .shape_W = &table});
  const auto world = bodies.build(kTick);
  for (int tick = 0; tick < 2000; ++tick) {
    world->push(0, 0, {0, 0, -1}, {0.004, -0.003, 0.02});
    world->step(kTick);
  }
  EXPECT_LT(body(*world, 0).p_WC().head<2>().norm(), 1e-5);
}

TEST(CollisionWorld, ABallRubsInItsReboundToo) {
  MeetingBodies bodies;
  MotionChoice choice = MeetingBodies::rigid(0.1);
  choice.v_W = {0.5, 0, -0.5};
  bodies.add_sphere({0, 0, 0.05}, 0.01, choice, {.friction = 0.1});
  const Primitive table = HalfSpace{.n_W = {0, 0, 1}, .p_WO = {0, 0, 0}};
  bodies.add_fixed({.mesh_W = nullptr, .shape_W = &table}, {.friction = 0.1, .restitution = 0.5});
  const auto world = bodies.build(kTick);
  run(*world, 0.14);
  EXPECT_NEAR(body(*world, 0).v_WC().z(), 0.25, 0.003);
  EXPECT_NEAR(body(*world, 0).v_WC().x(), 0.5 - 0.1 * 1.5 * 0.5, 0.003);
}

TEST(CollisionWorld, SmallBodiesRestBesideLargeOnes) {
  MeetingBodies bodies;
  MotionChoice light = MeetingBodies::heavy(0.0005), heavy = MeetingBodies::heavy(5);
  bodies.add_box({0, 0, 0.0012}, Vector3d::Constant(0.001), light);
  bodies.add_sphere({0.02, 0, 0.0012}, 0.001, light);
  Capsule capsule;
  capsule.radius = 0.00125;
  capsule.half_height = 0.00125;
  capsule.p_WO = {0.04, 0, 0.0013};
  capsule.R_WO = Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitX()).toRotationMatrix();
  bodies.add(lying({{0.00125, 0.002}, {0.00125, -0.002}}, capsule.p_WO), light, {},
             Primitive(capsule));
  for (int i = 0; i < 4; ++i) {
    bodies.add_box({0.5 + 0.4 * i, 0.5, 0.15}, Vector3d::Constant(0.15), heavy);
  }
  const Primitive table = HalfSpace{.n_W = {0, 0, 1}, .p_WO = {0, 0, 0}};
  bodies.add_fixed({.mesh_W = nullptr, .shape_W = &table});
  const auto world = bodies.build(kTick);
  run(*world, 2);
  EXPECT_LT((body(*world, 0).p_WC() - Vector3d(0, 0, 0.001)).norm(), 1e-5);
  EXPECT_LT((body(*world, 1).p_WC() - Vector3d(0.02, 0, 0.001)).norm(), 1e-5);
  EXPECT_LT((body(*world, 2).p_WC() - Vector3d(0.04, 0, 0.00125)).norm(), 1e-5);
  EXPECT_NEAR(body(*world, 3).p_WC().z(), 0.15, 1e-5);
}

TEST(CollisionWorld, ABallRestsOnTheDiagonalOfAMesh) {
  for (const double radius : {0.001, 0.002, 0.01}) {
    for (const double off : {0.0, 1e-4, -1e-4, 0.003}) {
      MeetingBodies bodies;
      // The diagonals of the top go through its middle.
      bodies.add_sphere({off, 0, 0.025 + radius + 0.002}, radius, MeetingBodies::heavy(0.01));
      const TriangleMesh mesh = support::box({0.025, 0.025, 0.025});
      bodies.add_fixed({&mesh, nullptr}, {.shape = CollisionShape::kMesh});
      const auto world = bodies.build(kTick);
      run(*world, 1);
      const Vector3d p = body(*world, 0).p_WC();
      // The mesh is larger by a thousandth of its half side.
      EXPECT_LT((p - Vector3d(off, 0, 0.025 + radius)).norm(), 3e-5) << radius << " " << off;
    }
  }
}

TEST(CollisionWorld, ASmallBallDoesNotFallThroughAMesh) {
  for (int i = 0; i < 40; ++i) {
    MeetingBodies bodies;
    MotionChoice choice = MeetingBodies::rigid(0.005);
    choice.v_W = {0, 0, -2};
    bodies.add_sphere({0.003, 0.002, 0.03 + 1e-4 * i}, 0.001, choice);
    const TriangleMesh mesh = support::box({0.025, 0.025, 0.025});
    bodies.add_fixed({&mesh, nullptr}, {.shape = CollisionShape::kMesh});
    const auto world = bodies.build(kTick);
    run(*world, 0.1);
    EXPECT_GT(body(*world, 0).p_WC().z(), 0.025) << i;
  }
}

// Counts what Bullet takes from the heap.
int taken = 0;
void* take(std::size_t size) {
  ++taken;
  return std::malloc(size);
}

TEST(CollisionWorld, TakesMemoryInFewOfItsSteps) {
  btAlignedAllocSetCustom(&take, &std::free);
  Random random(std::uint64_t{3});
  MeetingBodies bodies;
  for (int k = 0; k < 20; ++k) {
    MotionChoice choice = MeetingBodies::heavy(0.05);
    choice.floor = Floor{.n_W = {0, 0, 1}, .height = 0, .friction = 0.5};
    const Vector3d p_W = random.in_box(0.015) + Vector3d(0, 0, 0.03 * k + 0.03);
    if (k % 2 == 0) {
      bodies.add_box(p_W, Vector3d::Constant(0.01), choice, {.restitution = 0.3});
    } else {
      bodies.add_sphere(p_W, 0.01, choice);
    }
  }
  const auto world = bodies.build(kTick);
  int ticks = 0;
  for (int tick = 0; tick < 2000; ++tick) {
    const int before = taken;
    world->step(kTick);
    if (taken != before) ++ticks;
  }
  EXPECT_GT(world->solver().counters().contacts_max, 30U);
  EXPECT_LE(ticks, 20);
  btAlignedAllocSetCustom(&std::malloc, &std::free);
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
