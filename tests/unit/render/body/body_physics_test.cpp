// Free bodies, springs and snapping panels compared with closed forms, for
// tests/acceptance/PHYSICS.md.
#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <cmath>
#include <numbers>

#include "body/motion/mass_properties.h"
#include "body/motion/rigid_body.h"
#include "body/motion/translating_body.h"
#include "body/shape/snap_truss.h"
#include "body/spring/oscillator.h"
#include "support/meshes/shapes.h"
#include "support/physics.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;
using support::expect_physics;

RigidBodySettings free_block() {
  RigidBodySettings settings;
  settings.mass = mass_properties(support::box({0.03, 0.02, 0.01}), 0.3).value();
  return settings;
}

TEST(PhysicsOfBodies, ABodyFallsAndFadesByTheLaws) {
  RigidBodySettings settings = free_block();
  settings.gravity_W = {0, 0, -9.81};
  RigidBody falling = RigidBody::build(settings).value();
  for (int i = 0; i < 500; ++i) falling.step(1e-3);
  expect_physics({"rigid body", "fall in 0.5 s", "-g t^2 / 2", "m", -9.81 / 2 * 0.25, 1e-12},
                 falling.p_WC().z());
  settings.gravity_W.setZero();
  settings.damping = 0.6;
  settings.angular_damping = 1e-4;
  RigidBody fading = RigidBody::build(settings).value();
  fading.set_momentum({0.3, 0, 0}, {0, 0, 1e-3});
  for (int i = 0; i < 1000; ++i) fading.step(1e-3);
  expect_physics({"rigid body", "speed after 1 s, 0.6 N s/m on 0.3 kg", "v exp(-c t / m)", "m/s",
                  std::exp(-2.0), 1e-9},
                 fading.v_WC().x());
  const double inertia = settings.mass.inertia[2];
  expect_physics({"rigid body", "turning rate after 1 s, 1e-4 N m s", "w exp(-c t / I)", "rad/s",
                  1e-3 / inertia * std::exp(-1e-4 / inertia), 1e-9},
                 fading.omega_W().z());
}

TEST(PhysicsOfBodies, MassPropertiesAreThoseOfABlock) {
  const MassProperties found = free_block().mass;
  expect_physics({"rigid body", "largest inertia of a block of 60 x 40 x 20 mm, 0.3 kg",
                  "m (a^2 + b^2) / 12", "kg m^2", 0.3 / 12 * (0.06 * 0.06 + 0.04 * 0.04), 1e-12},
                 found.inertia[2]);
}

// A block that spins nearly about its long axis wobbles at w sqrt((I3 - I1)(I2 - I1) / (I2 I3)).
TEST(PhysicsOfBodies, ASpinningBlockWobblesAtTheRateOfEuler) {
  RigidBody body = RigidBody::build(free_block()).value();
  const Vector3d inertia = body.settings().mass.inertia;
  const double spin = 20;
  body.set_momentum({0, 0, 0}, body.q_WB() * inertia.cwiseProduct(Vector3d(spin, 1e-3, 0)));
  double before = 1e-3, first = -1, last = -1;
  int crossings = 0;
  for (int i = 1; i <= 10000; ++i) {
    body.step(1e-3);
    const double now = (body.q_WB().conjugate() * body.omega_W())[1];
    if (before > 0 && now <= 0) {
      last = i - 1 + before / (before - now);
      if (crossings++ == 0) first = last;
    }
    before = now;
  }
  const double rate = spin * std::sqrt((inertia[2] - inertia[0]) * (inertia[1] - inertia[0]) /
                                       (inertia[1] * inertia[2]));
  expect_physics({"rigid body", "wobble of a block spun about its long axis at 20 rad/s",
                  "w sqrt((I3 - I1)(I2 - I1) / (I2 I3))", "rad/s", rate, 1e-5},
                 2 * std::numbers::pi * (crossings - 1) / ((last - first) * 1e-3));
}

TEST(PhysicsOfBodies, ATimeScaleMakesABodyHeavier) {
  TranslatingBody body(0.3, 0, 0.5, 1e-3);
  for (int i = 0; i < 300; ++i) {
    body.push({0.2, 0, 0});
    body.step();
  }
  expect_physics({"translating body", "way in 0.3 s by 0.2 N, 0.3 kg, time scale 0.5",
                  "F s^2 t^2 / (2 m)", "m", 0.2 * 0.25 * 0.09 / (2 * 0.3), 1e-9},
                 body.p_W().x());
}

TEST(PhysicsOfSprings, ANodeSwingsByItsClosedForm) {
  const double mass = 1e-3, stiffness = 400, damping = 0.2;
  const OscillatorStep step = OscillatorStep::of(mass, stiffness, damping, 1e-3);
  double x = 1e-3, v = 0;
  for (int i = 0; i < 25; ++i) step.apply(x, v, 0.0);
  const double fade = damping / (2 * mass);
  const double omega = std::sqrt(stiffness / mass - fade * fade);
  const double t = 0.025;
  expect_physics(
      {"spring node", "place after 25 ms, 1 g, 400 N/m, 0.2 N s/m, from 1 mm",
       "exp(-a t) (cos(w t) + a / w sin(w t))", "m",
       1e-3 * std::exp(-fade * t) * (std::cos(omega * t) + fade / omega * std::sin(omega * t)),
       1e-9},
      x);
}

TEST(PhysicsOfSprings, APanelSnapsAtTheLoadOfTheTruss) {
  const SnapTruss truss(20e-3, 6e-3, 5000);
  const double rest = std::sqrt(20e-3 * 20e-3 + 6e-3 * 6e-3);
  const double length = std::cbrt(rest * 20e-3 * 20e-3);
  const double rise = std::sqrt(length * length - 20e-3 * 20e-3);
  expect_physics(
      {"snap", "limit load of a truss, half span 20 mm, rise 6 mm, bars of 5000 N/m",
       "2 k (L0 / L - 1)(H - u) at L^3 = L0 a^2", "N", 2 * 5000 * (rest / length - 1) * rise, 1e-9},
      truss.limit_load());
  expect_physics({"snap", "its stiffness at rest", "2 k (H / L0)^2", "N/m",
                  2 * 5000 * (6e-3 / rest) * (6e-3 / rest), 1e-9},
                 truss.stiffness(0));
}

}  // namespace
}  // namespace thimble::render
