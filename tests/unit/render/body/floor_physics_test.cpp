// Bodies on a floor compared with closed forms: sliding, stopping, pushing, spinning, tilting,
// rocking, impacts.
#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "body/motion/body_motions.h"
#include "body/motion/floor_impulses.h"
#include "body/motion/mass_properties.h"
#include "body/motion/rigid_body.h"
#include "support/hard_case.h"
#include "support/heap_guard.h"
#include "support/meshes/shapes.h"
#include "support/physics.h"
#include "support/random.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;
using support::expect_physics;

constexpr double kTick = 1e-3;
constexpr double kGravity = 9.81;  // m/s^2
const char* const kBody = "rigid body on a floor";
const char* const kMover = "translating body on a floor";

struct Stand {
  double friction = 0;
  double mass = 0.1;  // kg
  double gravity = kGravity;
  Vector3d at{0, 0, 0};  // m, moves the block
  Eigen::Quaterniond turned = Eigen::Quaterniond::Identity();
};

// Returns a block with the given half sides (m), standing on z = 0 unless it is moved.
RigidBody block(const Vector3d& half, const Stand& stand) {
  TriangleMesh mesh = support::box(half);
  for (Vector3d& p : mesh.vertices) {
    p = stand.turned * p + Vector3d(0, 0, half.z()) + stand.at;
  }
  RigidBodySettings settings;
  settings.mass = mass_properties(mesh, stand.mass).value();
  settings.gravity_W = {0, 0, -stand.gravity};
  settings.floor = Floor{.friction = stand.friction};
  for (const Vector3d& p : mesh.vertices) {
    settings.support_B.push_back(settings.mass.q_WB.conjugate() * (p - settings.mass.p_WC));
  }
  return RigidBody::build(settings).value();
}

// A disc that stands on `points` points of its rim; its centre is 5 mm above the floor.
constexpr double kRadius = 0.03;
RigidBody disc(int points, double friction, double mass = 0.2) {
  RigidBodySettings settings;
  const double inertia = mass * kRadius * kRadius / 2;
  settings.mass.mass = mass;
  settings.mass.inertia = {inertia / 2, inertia / 2, inertia};
  settings.mass.p_WC = {0, 0, 0.005};
  settings.gravity_W = {0, 0, -kGravity};
  settings.floor = Floor{.friction = friction};
  for (int i = 0; i < points; ++i) {
    const double turn = 2 * std::numbers::pi * i / points + 0.1;
    settings.support_B.emplace_back(kRadius * std::cos(turn), kRadius * std::sin(turn), -0.005);
  }
  return RigidBody::build(settings).value();
}

// Returns a body that cannot tip over: its inertia is very large, and it stands on 1 or 2 points.
RigidBody point_stand(int points, double friction) {
  RigidBodySettings settings;
  settings.mass.mass = 0.2;
  settings.mass.inertia = {1e6, 1e6, 1e6};
  settings.mass.p_WC = {0, 0, 0.005};
  settings.gravity_W = {0, 0, -kGravity};
  settings.floor = Floor{.friction = friction};
  for (int i = 0; i < points; ++i)
    settings.support_B.emplace_back(0, 0.02 * (i - (points - 1) / 2.0), -0.005);
  return RigidBody::build(settings).value();
}

RigidBody stand_on(int points, double friction) {
  return points < 3 ? point_stand(points, friction) : disc(points, friction);
}

double speed_after_sliding(RigidBody body, int ticks) {
  body.step(kTick);
  body.set_momentum({body.settings().mass.mass * 1.0, 0, 0}, {0, 0, 0});
  for (int i = 0; i < ticks; ++i) body.step(kTick);
  return body.v_WC().x();
}

TEST(PhysicsOfFloors, SlidingSlowsDownByFrictionTimesGravity) {
  for (const int points : {1, 2, 3, 4, 6, 8, 12, 16}) {
    for (const double mu : {0.1, 0.3}) {
      const double found = (1 - speed_after_sliding(stand_on(points, mu), 100)) / 0.1;
      EXPECT_NEAR(found, mu * kGravity, 1e-6 * kGravity) << points << " points, mu " << mu;
      if (mu < 0.3 || (points != 1 && points != 4 && points != 16)) continue;
      expect_physics({kBody,
                      "deceleration of sliding, mu = 0.3, " + std::to_string(points) +
                          " support point" + (points > 1 ? "s" : ""),
                      "mu g", "m/s^2", mu * kGravity, 1e-6},
                     found);
    }
  }
}

TEST(PhysicsOfFloors, SlidingStopsAtTheDistanceOfTheLaw) {
  RigidBody body = block({0.02, 0.02, 0.01}, {.friction = 0.3});
  body.set_momentum({0.1 * 0.5, 0, 0}, {0, 0, 0});
  for (int i = 0; i < 400; ++i) body.step(kTick);
  expect_physics({kBody, "stopping distance from 0.5 m/s, mu = 0.3", "v^2 / (2 mu g)", "m",
                  0.25 / (2 * 0.3 * kGravity), 1e-4},
                 body.p_WC().x());
  EXPECT_EQ(body.kinetic_energy(), 0);
}

TEST(PhysicsOfFloors, PushAboveFrictionAcceleratesByTheRest) {
  for (const double push : {3.5, 5.0, 20.0}) {
    RigidBody body = block({0.05, 0.05, 0.02}, {.friction = 0.3, .mass = 1});
    for (int i = 0; i < 500; ++i) {
      body.push({push, 0, 0}, body.p_WC() - Vector3d(0, 0, 0.02));
      body.step(kTick);
    }
    const double truth = (push - 0.3 * kGravity) * 0.5;
    char words[80];
    std::snprintf(words, sizeof words, "speed after 0.5 s, 1 kg pushed by %g N, mu = 0.3", push);
    expect_physics({kBody, words, "(F / m - mu g) t", "m/s", truth, 1e-6}, body.v_WC().x());
  }
}

TEST(PhysicsOfFloors, NothingCreepsBelowStaticFriction) {
  double worst = 0;
  for (const double mu : {0.1, 0.3, 0.5, 1.0}) {
    for (const double share : {0.2, 0.5, 0.8, 0.95}) {
      for (const double tick : {1e-2, 1e-3, 1e-4}) {
        RigidBody body = block({0.02, 0.02, 0.01}, {.friction = mu});
        const Vector3d at = body.p_WC();
        for (int i = 0; i < 200; ++i) {
          body.push({share * mu * 0.1 * kGravity, 0, 0}, body.p_WC() - Vector3d(0, 0, 0.01));
          body.step(tick);
        }
        worst = std::max(worst, (body.p_WC() - at).norm());
      }
    }
  }
  expect_physics(
      {kBody, "way in 200 ticks below static friction, 10 Hz to 10 kHz", "0", "m", 0, 1e-9, 1},
      worst);
}

TEST(PhysicsOfFloors, ASpinningDiscSlowsDownByTheTorqueOfItsRim) {
  for (const int points : {3, 4, 8, 16}) {
    RigidBody body = disc(points, 0.3);
    const double inertia = body.settings().mass.inertia.z();
    body.set_momentum({0, 0, 0}, {0, 0, 50 * inertia});
    for (int i = 0; i < 100; ++i) body.step(kTick);
    const double truth = 50 - 0.3 * 0.2 * kGravity * kRadius / inertia * 0.1;
    EXPECT_NEAR(body.omega_W().z(), truth, 1e-6 * truth) << points;
    EXPECT_LT(body.v_WC().norm(), 1e-6);
    if (points != 16) continue;
    expect_physics({kBody, "angular velocity after 0.1 s, disc on 16 points of its rim, mu = 0.3",
                    "w - mu m g r t / I", "rad/s", truth, 1e-6},
                   body.omega_W().z());
  }
}

// A block pushed at its upper edge tips over if F 2 h > m g w.
TEST(PhysicsOfFloors, ABlockTipsAtTheForceOfTheLaw) {
  const double w = 0.01, h = 0.02;
  const auto turns = [&](double force) {
    RigidBody body = block({w, 0.02, h}, {.friction = 5});
    for (int i = 0; i < 200; ++i) {
      body.push({force, 0, 0}, body.p_WC() + Vector3d(0, 0, h));
      body.step(kTick);
    }
    return body.omega_W().norm() > 1e-3;
  };
  const double truth = 0.1 * kGravity * w / (2 * h);
  double low = 0.5 * truth, high = 2 * truth;
  for (int i = 0; i < 14; ++i) {
    const double middle = (low + high) / 2;
    (turns(middle) ? high : low) = middle;
  }
  expect_physics({kBody, "force at the upper edge that tips a block of 20 x 40 mm", "m g w / (2 h)",
                  "N", truth, 1e-3},
                 (low + high) / 2);
}

// On an inclined plane, a body slides beyond the friction angle, and a block tips beyond w / h.
TEST(PhysicsOfFloors, ABlockSlidesOnAPlaneSteeperThanItsFriction) {
  const auto speed = [](double slope) {
    RigidBody body = block({0.02, 0.02, 0.005}, {.friction = 0.3, .gravity = 0});
    RigidBodySettings settings = body.settings();
    settings.gravity_W = kGravity * Vector3d(std::sin(slope), 0, -std::cos(slope));
    body = RigidBody::build(settings).value();
    for (int i = 0; i < 100; ++i) body.step(kTick);
    return body.v_WC().x();
  };
  const double edge = std::atan(0.3);
  EXPECT_EQ(speed(0.99 * edge), 0);
  const double steep = 1.5 * edge;
  expect_physics({kBody, "acceleration on a slope of 25 degrees, mu = 0.3", "g (sin a - mu cos a)",
                  "m/s^2", kGravity * (std::sin(steep) - 0.3 * std::cos(steep)), 1e-6},
                 speed(steep) / 0.1);
}

TEST(PhysicsOfFloors, AFlatDropNeitherReboundsNorTumbles) {
  double rebound = 0, tumble = 0;
  for (const double tick : {1e-2, 1e-3, 1e-4}) {
    for (const Vector3d& half :
         {Vector3d(0.02, 0.02, 0.02), Vector3d(0.05, 0.02, 0.01), Vector3d(0.01, 0.01, 0.05),
          Vector3d(0.05, 0.01, 0.05), Vector3d(0.04, 0.03, 0.005), Vector3d(0.001, 0.001, 0.05)}) {
      for (const double mu : {0.0, 0.5}) {
        RigidBody body = block(half, {.friction = mu, .gravity = 0, .at = {0, 0, 3.3e-3}});
        body.set_momentum({0, 0, -0.1}, {0, 0, 0});
        for (int i = 0; i < 60; ++i) {
          body.step(tick);
          rebound = std::max(rebound, body.v_WC().z());
          tumble = std::max(tumble, body.omega_W().norm() * half.maxCoeff());
        }
      }
    }
  }
  expect_physics({kBody, "rebound of a flat drop at 1 m/s, 6 blocks, 100 Hz to 10 kHz", "0", "m/s",
                  0, 1e-9, 1},
                 rebound);
  expect_physics({kBody, "the same: speed of a corner by tumbling", "0", "m/s", 0, 1e-9, 1},
                 tumble);
}

// A block that falls on one of its edges turns about this edge and about no other axis.
TEST(PhysicsOfFloors, AnEdgeHitDoesNotRoll) {
  double roll = 0;
  for (const double angle : {0.2, 0.6, 1.0}) {
    const Vector3d half(0.05, 0.02, 0.01);
    const double low = half.x() * std::sin(angle) + half.z() * std::cos(angle);
    RigidBody body =
        block(half, {.gravity = 0,
                     .at = {0, 0, low - half.z() + 3e-3},
                     .turned = Eigen::Quaterniond(Eigen::AngleAxisd(angle, Vector3d::UnitY()))});
    body.set_momentum({0, 0, -0.1}, {0, 0, 0});
    for (int i = 0; i < 8; ++i) body.step(kTick);
    const Vector3d omega = body.omega_W();
    roll = std::max({roll, std::abs(omega.x()), std::abs(omega.z())});
    // The impulse P at the edge: v = P / m - v0, and the edge comes to rest.
    const Vector3d arm =
        Eigen::AngleAxisd(angle, Vector3d::UnitY()) * Vector3d(half.x(), 0, -half.z());
    const double inertia = 0.1 / 3 * (half.x() * half.x() + half.z() * half.z());
    const double gain = 1 / 0.1 + arm.x() * arm.x() / inertia;
    const double truth = -arm.x() / gain / inertia;
    if (angle != 0.6) continue;
    expect_physics({kBody, "angular velocity after an edge hit at 1 m/s, 0.6 rad, no friction",
                    "-m x v / (I + m x^2)", "rad/s", truth, 1e-6},
                   omega.y());
  }
  expect_physics(
      {kBody, "the same: rolling about the other axes, 3 angles", "0", "rad/s", 0, 1e-9, 1}, roll);
}

// [Housner]: a block that rocks onto its other edge keeps 1 - 1.5 sin^2(a) of its angular velocity,
// with tan(a) = w / h.
TEST(PhysicsOfFloors, RockingBlockLosesSpeedByHousner) {
  for (const double w : {0.01, 0.02, 0.03}) {
    const double h = 0.05, tick = 1e-4;
    const double alpha = std::atan(w / h), start = alpha / 2;
    // Leaning on its left edge, which is at the origin.
    const Eigen::Quaterniond lean(Eigen::AngleAxisd(-start, Vector3d::UnitY()));
    const Vector3d centre = lean * Vector3d(w, 0, h);
    RigidBody body =
        block({w, 0.02, h},
              {.friction = 3, .mass = 0.2, .at = centre - Vector3d(0, 0, h), .turned = lean});
    const Eigen::Quaterniond first = body.q_WB();
    // The tilt at which it turns back on the other edge gives the remaining energy.
    double farthest = 0;
    for (int i = 0; i < 20000; ++i) {
      body.step(tick);
      const Vector3d up = body.q_WB() * (first.conjugate() * (lean * Vector3d::UnitZ()));
      const double tilt = std::atan2(up.x(), up.z());
      if (tilt > 0 && body.omega_W().y() < 0) break;
      farthest = std::max(farthest, tilt);
    }
    const double kept = std::sqrt((std::cos(alpha - farthest) - std::cos(alpha)) /
                                  (std::cos(alpha - start) - std::cos(alpha)));
    char words[100];
    std::snprintf(words, sizeof words,
                  "angular velocity kept when rocking over, block of %g x 100 mm", 2e3 * w);
    expect_physics({kBody, words, "1 - 1.5 sin^2(a), tan(a) = w / h", "1",
                    1 - 1.5 * std::sin(alpha) * std::sin(alpha), 0.005},
                   kept);
  }
}

// A top on its tip precesses steadily where I' W^2 cos(t) - I3 w3 W + m g l = 0.
TEST(PhysicsOfFloors, ATopPrecessesAtTheRateOfTheLaw) {
  const double l = 0.03, across = 1.8e-5, along = 2e-5, tilt = 0.3, spin = 300, mass = 0.1;
  const double about_tip = across + mass * l * l;
  const double a = about_tip * std::cos(tilt), b = along * spin, c = mass * kGravity * l;
  const double rate = (b - std::sqrt(b * b - 4 * a * c)) / (2 * a);
  RigidBodySettings settings;
  settings.mass.mass = mass;
  settings.mass.inertia = {across, across, along};
  settings.mass.q_WB = Eigen::Quaterniond(Eigen::AngleAxisd(tilt, Vector3d::UnitY()));
  const Vector3d axis = settings.mass.q_WB * Vector3d::UnitZ();
  settings.mass.p_WC = l * axis;
  settings.gravity_W = {0, 0, -kGravity};
  settings.floor = Floor{.friction = 5};
  settings.support_B = {{0, 0, -l}};
  RigidBody body = RigidBody::build(settings).value();
  const Vector3d omega = rate * Vector3d::UnitZ() + (spin - rate * std::cos(tilt)) * axis;
  const Vector3d omega_B = settings.mass.q_WB.conjugate() * omega;
  body.set_momentum(mass * omega.cross(settings.mass.p_WC),
                    settings.mass.q_WB * settings.mass.inertia.cwiseProduct(omega_B));
  for (int i = 0; i < 5000; ++i) body.step(1e-4);
  const Vector3d now = body.q_WB() * Vector3d::UnitZ();
  expect_physics({kBody, "precession of a top of 300 rad/s in 0.5 s",
                  "I1 W^2 cos(t) - I3 w3 W + m g l = 0", "rad", rate * 0.5, 1e-3},
                 std::atan2(now.y(), now.x()));
}

TEST(PhysicsOfFloors, ABodyThatOnlyTranslatesObeysTheSameLaws) {
  const auto motion = [](double friction) {
    return TranslatingMotion(TranslatingBody(0.1, 0, 1, kTick),
                             {.mass = 0.1,
                              .gravity_W = {0, 0, -kGravity},
                              .floor = Floor{.friction = friction},
                              .lowest = 0});
  };
  TranslatingMotion held = motion(0.3);
  for (int i = 0; i < 200; ++i) {
    held.push({0.95 * 0.3 * 0.1 * kGravity, 0, 0}, {0, 0, 0});
    held.step(kTick);
  }
  expect_physics({kMover, "way in 200 ticks at 0.95 of static friction", "0", "m", 0, 1e-12, 1},
                 held.p_WB().norm());
  TranslatingMotion pushed = motion(0.3);
  for (int i = 0; i < 200; ++i) {
    pushed.push({2 * 0.3 * 0.1 * kGravity, 0, 0}, {0, 0, 0});
    pushed.step(kTick);
  }
  expect_physics({kMover, "speed after 0.2 s, pushed by twice static friction", "(F / m - mu g) t",
                  "m/s", 0.3 * kGravity * 0.2, 1e-9},
                 pushed.body().v_W().x());
  for (int i = 0; i < 100; ++i) pushed.step(kTick);
  expect_physics(
      {kMover, "deceleration of sliding, mu = 0.3", "mu g", "m/s^2", 0.3 * kGravity, 1e-9},
      (0.3 * kGravity * 0.2 - pushed.body().v_W().x()) / 0.1);
}

// The conditions that the impulses must satisfy, in random states on up to 16 points.
TEST(FloorImpulses, SatisfyTheConditionsOfContactAndFriction) {
  support::Random random(12);
  int unsolved = 0;
  double worst = 0;
  for (int i = 0; i < 3000; ++i) {
    const double mu = i % 4 == 0 ? 0 : std::pow(10, random.uniform(-1.5, 0.5));
    const Vector3d inertia =
        1e-4 * Vector3d(random.uniform(1, 2), random.uniform(1, 2), random.uniform(1, 2));
    const Vector3d n = random.direction();
    FloorImpulses impulses(0.1, inertia, n, mu);
    const int points = 1 + i % 16;
    std::vector<std::pair<Vector3d, double>> stands;
    for (int k = 0; k < points; ++k) {
      Vector3d arm = random.in_box(0.05);
      if (i % 2 == 0) arm -= (n.dot(arm) + 0.02) * n;  // all in the floor's plane
      stands.emplace_back(arm, i % 3 == 0 ? random.uniform(0, 0.1) : 0);
      impulses.add(arm, stands.back().second);
    }
    Vector3d v = random.in_box(0.5), omega = random.in_box(5);
    const Vector3d v_0 = v, omega_0 = omega;
    const auto energy = [&](const Vector3d& velocity, const Vector3d& turning) {
      return 0.1 * velocity.squaredNorm() / 2 + inertia.cwiseProduct(turning).dot(turning) / 2;
    };
    if (!impulses.solve(v, omega)) ++unsolved;
    EXPECT_LE(energy(v, omega), energy(v_0, omega_0) * (1 + 1e-12));
    for (const auto& [arm, allowed] : stands) {
      worst = std::max(worst, -n.dot(v + omega.cross(arm)) - allowed);
    }
  }
  EXPECT_LT(worst, 2e-6);  // m/s
  EXPECT_LE(unsolved,
            100);  // of 3000 states harsher than any tick of a body: 1 to 16 points, mu to 3
}

// If all points slide in the same direction, each carries a part of the load, and their order does
// not matter.
TEST(FloorImpulses, DoNotDependOnTheOrderOfThePoints) {
  support::Random random(13);
  for (int i = 0; i < 300; ++i) {
    std::vector<Vector3d> arms;
    for (int k = 0; k < 8; ++k) {
      arms.push_back(random.in_box(0.05));
      arms.back().z() = -0.02;
    }
    Vector3d v[2] = {random.in_box(0.5) - Vector3d(0, 0, 0.5), {}},
             omega[2] = {random.in_box(5), {}};
    v[1] = v[0];
    omega[1] = omega[0];
    for (int order = 0; order < 2; ++order) {
      FloorImpulses impulses(0.1, {1e-4, 1.2e-4, 1.5e-4}, {0, 0, 1}, 0.2);
      for (std::size_t k = 0; k < arms.size(); ++k) {
        impulses.add(arms[order == 0 ? k : arms.size() - 1 - k], 0);
      }
      impulses.solve(v[order], omega[order]);
    }
    EXPECT_LT((v[0] - v[1]).norm(), 1e-6);
    EXPECT_LT((omega[0] - omega[1]).norm(), 1e-4);
  }
}

TEST(FloorImpulses, AreBoundedInTimeAndUseNoHeap) {
  int most = 0;
  for (const double mu : {0.0, 0.3, 1.0, 10.0}) {
    support::Random random(14);
    for (int i = 0; i < 100; ++i) {
      FloorImpulses impulses(0.1, {1e-4, 1.2e-4, 1.5e-4}, {0, 0, 1}, mu);
      for (std::size_t k = 0; k < FloorImpulses::kPointsMax; ++k) {
        impulses.add(random.in_box(0.05) + Vector3d(0, 0, -0.06), 0);
      }
      Vector3d v = random.in_box(0.5), omega = random.in_box(5);
      EXPECT_EQ(support::heap_calls_of([&] { impulses.solve(v, omega); }), 0);
      most = std::max(most, impulses.iterations());
      EXPECT_TRUE(v.allFinite() && omega.allFinite());
    }
  }
  EXPECT_LE(most * static_cast<int>(FloorImpulses::kPointsMax), 2 * FloorImpulses::kPointStepsMax);
}

TEST(FloorImpulses, LeaveVelocitiesThatAreNotFinite) {
  for (const double bad : {std::nan(""), static_cast<double>(HUGE_VALF)}) {
    FloorImpulses impulses(0.1, {1e-4, 1e-4, 1e-4}, {0, 0, 1}, 0.4);
    impulses.add({0, 0, -0.01}, 0);
    Vector3d v(bad, 0, -1), omega(0, 0, 0);
    impulses.solve(v, omega);
    EXPECT_EQ(v.z(), -1);
  }
}

}  // namespace
}  // namespace thimble::render
