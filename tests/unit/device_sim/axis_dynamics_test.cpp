#include "plant/axis_dynamics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "axis_reference.h"
#include "support/random.h"
#include "support/refuses.h"

namespace thimble::device_sim {
namespace {

using support::refuses;

constexpr std::int64_t kMillisecond = 1'000'000;

struct Case {
  PlantSettings plant;
  HandSettings hand;
  AxisDrive drive;
  AxisState start;
};

Case random_case(support::Random& random) {
  Case c;
  c.plant.mass = std::pow(10.0, random.uniform(-2, 0));
  c.plant.viscous = random.uniform(0, 1) < 0.3 ? 0 : random.uniform(0, 5);
  c.plant.coulomb = random.uniform(0, 1) < 0.1 ? 0 : random.uniform(0, 1);
  if (random.uniform(0, 1) < 0.7) {
    c.hand.mass = random.uniform(0, 0.1);
    c.hand.stiffness = std::pow(10.0, random.uniform(0, 5));
    c.hand.damping = random.uniform(0, 1) < 0.3 ? 0 : std::pow(10.0, random.uniform(-1, 2));
  }
  c.drive.force = random.uniform(-1, 1);
  c.drive.anchor = random.uniform(-1, 1) / std::max(1.0, c.hand.stiffness);
  c.drive.anchor_speed = random.uniform(-0.2, 0.2);
  c.start.x = random.uniform(-1e-3, 1e-3);
  c.start.v = random.uniform(0, 1) < 0.3 ? 0 : random.uniform(-0.02, 0.02);
  return c;
}

TEST(AxisDynamics, MatchesAnIndependentIntegratorThroughAllEvents) {
  support::Random random(3);
  std::uint64_t reversals = 0, breakaways = 0;
  for (int i = 0; i < 1000; ++i) {
    const Case c = random_case(random);
    AxisDynamics axis = AxisDynamics::make(c.plant, c.hand).value();
    AxisState state = c.start;
    const std::int64_t dt_ns = i % 2 == 0 ? kMillisecond : 10 * kMillisecond;
    axis.step(state, c.drive, dt_ns);
    long double x = c.start.x, v = c.start.v;
    AxisReference(c.plant, c.hand, c.drive)
        .run(x, v, static_cast<long double>(dt_ns) * 1e-9L, 4000);
    ASSERT_NEAR(state.x, static_cast<double>(x), 1e-12) << "case " << i;
    ASSERT_NEAR(state.v, static_cast<double>(v), 1e-10) << "case " << i;
    ASSERT_EQ(state.v == 0, v == 0) << "case " << i;
    ASSERT_EQ(axis.counters().unresolved, 0U);
    reversals += axis.counters().reversals;
    breakaways += axis.counters().breakaways;
  }
  // The cases must include the events that they test.
  EXPECT_GT(reversals, 200U);
  EXPECT_GT(breakaways, 10U);
}

TEST(AxisDynamics, SplittingAStepDoesNotChangeTheResult) {
  support::Random random(4);
  for (int i = 0; i < 20000; ++i) {
    const Case c = random_case(random);
    AxisDynamics axis = AxisDynamics::make(c.plant, c.hand).value();
    AxisState whole = c.start, parts = c.start;
    const auto cut_ns = static_cast<std::int64_t>(random.uniform(1, 999'999));
    axis.step(whole, c.drive, kMillisecond);
    axis.step(parts, c.drive, cut_ns);
    AxisDrive later = c.drive;
    later.anchor += c.drive.anchor_speed * static_cast<double>(cut_ns) * 1e-9;
    axis.step(parts, later, kMillisecond - cut_ns);
    ASSERT_NEAR(whole.x, parts.x, 1e-17) << "case " << i;
    ASSERT_NEAR(whole.v, parts.v, 2e-14) << "case " << i;
  }
}

TEST(AxisDynamics, FollowsTheClosedFormOfADampedOscillator) {
  const PlantSettings plant{.mass = 0.075, .viscous = 0.5, .coulomb = 0};
  HandSettings hand;
  hand.mass = 0.025;
  hand.stiffness = 300;
  AxisDynamics axis = AxisDynamics::make(plant, hand).value();
  AxisState state{.x = 0.01, .v = 0};
  const double gamma = 2.5, w = std::sqrt(3000 - gamma * gamma);
  for (int k = 1; k <= 2000; ++k) {
    axis.step(state, {}, kMillisecond);
    const double t = k * 1e-3;
    const double expected =
        0.01 * std::exp(-gamma * t) * (std::cos(w * t) + gamma / w * std::sin(w * t));
    ASSERT_NEAR(state.x, expected, 1e-15);
  }
}

TEST(AxisDynamics, CoulombFrictionStopsAfterTheExpectedDistance) {
  const PlantSettings plant{.mass = 0.075, .viscous = 0, .coulomb = 0.04};
  AxisDynamics axis = AxisDynamics::make(plant, {}).value();
  for (const double v : {1e-6, 1e-3, 0.01, 0.2, 0.9}) {
    AxisState state{.x = 0, .v = v};
    for (int k = 0; k < 2000; ++k) axis.step(state, {}, kMillisecond);
    EXPECT_EQ(state.v, 0);
    EXPECT_NEAR(state.x / (v * v * plant.mass / (2 * plant.coulomb)), 1, 2e-13);
  }
}

TEST(AxisDynamics, KeepsAHeldAxisExactlyAtRest) {
  const PlantSettings plant{.mass = 0.075, .viscous = 0.005, .coulomb = 0.04};
  HandSettings hand;
  hand.stiffness = 300;
  hand.damping = 3;
  AxisDynamics axis = AxisDynamics::make(plant, hand).value();
  AxisState state{.x = 0.0123, .v = 0};
  for (int k = 0; k < 1000; ++k) {
    const double force = 0.0399 * std::sin(0.1 * k);
    axis.step(state, {.force = force, .anchor = 0.0123}, kMillisecond);
    ASSERT_EQ(state.x, 0.0123);
    ASSERT_EQ(state.v, 0);
  }
  EXPECT_EQ(axis.counters().reversals + axis.counters().breakaways, 0U);
  axis.step(state, {.force = 0.0401, .anchor = 0.0123}, kMillisecond);
  EXPECT_GT(state.v, 0);
}

TEST(AxisDynamics, BreaksLooseAtTheExpectedTime) {
  const PlantSettings plant{.mass = 0.1, .viscous = 0, .coulomb = 0.04};
  HandSettings hand;
  hand.stiffness = 100;
  AxisDynamics axis = AxisDynamics::make(plant, hand).value();
  AxisState state;
  // 100 N/m * 1 m/s * t = 0.04 N at t = 0.4 ms; then v = 1 m/s * (1 - cos w(t - 0.4 ms)).
  axis.step(state, {.anchor_speed = 1}, kMillisecond);
  const double w = std::sqrt(1000.0);
  EXPECT_NEAR(state.v, 1 - std::cos(w * 0.6e-3), 1e-16);
  EXPECT_NEAR(state.x, 0.6e-3 - std::sin(w * 0.6e-3) / w, 1e-18);
  EXPECT_EQ(axis.counters().breakaways, 1U);
}

TEST(AxisDynamics, FindsAReversalInsideAStep) {
  // The axis moves against the spring of a receding hand. It stops, is held by friction and moves
  // on in its old direction, all within one step.
  const PlantSettings plant{.mass = 0.01, .viscous = 0, .coulomb = 0.05};
  HandSettings hand;
  hand.stiffness = 2000;
  AxisDynamics axis = AxisDynamics::make(plant, hand).value();
  const AxisDrive drive{.force = 0, .anchor = -0.0002, .anchor_speed = 1};
  AxisState state{.x = 0, .v = 0.001};
  axis.step(state, drive, kMillisecond);
  EXPECT_GT(state.v, 0);
  EXPECT_GE(axis.counters().reversals, 1U);
  long double x = 0, v = 0.001L;
  AxisReference({.mass = 0.01, .viscous = 0, .coulomb = 0.05}, hand, drive).run(x, v, 1e-3L, 4000);
  EXPECT_NEAR(state.x, static_cast<double>(x), 1e-13);
  EXPECT_NEAR(state.v, static_cast<double>(v), 1e-11);
}

TEST(AxisDynamics, NeverGainsEnergyWithoutADrive) {
  support::Random random(5);
  for (int i = 0; i < 300; ++i) {
    Case c = random_case(random);
    c.drive = {};
    AxisDynamics axis = AxisDynamics::make(c.plant, c.hand).value();
    AxisState state = c.start;
    const auto energy = [&] {
      return 0.5 * axis.mass() * state.v * state.v + 0.5 * c.hand.stiffness * state.x * state.x;
    };
    double before = energy();
    for (int k = 0; k < 200; ++k) {
      axis.step(state, c.drive, static_cast<std::int64_t>(random.uniform(1, 3e6)));
      ASSERT_LE(energy(), before * (1 + 1e-13)) << "case " << i;
      before = energy();
    }
  }
}

TEST(AxisDynamics, MirroredMotionIsBitIdentical) {
  support::Random random(6);
  for (int i = 0; i < 2000; ++i) {
    const Case c = random_case(random);
    AxisDynamics axis = AxisDynamics::make(c.plant, c.hand).value();
    AxisState right = c.start, left{-c.start.x, -c.start.v};
    axis.step(right, c.drive, kMillisecond);
    axis.step(left, {-c.drive.force, -c.drive.anchor, -c.drive.anchor_speed}, kMillisecond);
    ASSERT_EQ(right.x, -left.x);
    ASSERT_EQ(right.v, -left.v);
  }
}

TEST(AxisDynamics, StaysBoundedForVeryStiffAndVeryDampedHands) {
  const PlantSettings plant{.mass = 0.01, .viscous = 0, .coulomb = 0.04};
  for (const double stiffness : {0.0, 1e3, 1e6, 1e9}) {
    for (const double damping : {0.0, 1e1, 1e5}) {
      HandSettings hand;
      hand.stiffness = stiffness;
      hand.damping = damping;
      AxisDynamics axis = AxisDynamics::make(plant, hand).value();
      AxisState state{.x = 1e-4, .v = 0.1};
      const double energy = 0.5 * 0.01 * 0.01 + 0.5 * stiffness * 1e-8;
      for (int k = 0; k < 100; ++k) axis.step(state, {}, kMillisecond);
      EXPECT_LE(0.5 * 0.01 * state.v * state.v + 0.5 * stiffness * state.x * state.x, energy);
      EXPECT_EQ(axis.counters().unresolved, 0U);
    }
  }
}

TEST(AxisDynamics, ZeroStepChangesNothing) {
  AxisDynamics axis = AxisDynamics::make({.mass = 0.1, .viscous = 0, .coulomb = 0}, {}).value();
  AxisState state{.x = 1, .v = 2};
  axis.step(state, {.force = 3}, 0);
  axis.step(state, {.force = 3}, -5);
  EXPECT_EQ(state.x, 1);
  EXPECT_EQ(state.v, 2);
}

TEST(AxisDynamics, RefusesConstantsOutOfRange) {
  const PlantSettings good{.mass = 0.1, .viscous = 0, .coulomb = 0};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(refuses(AxisDynamics::make({.mass = 0, .viscous = 0, .coulomb = 0}, {}), "tip mass"));
  EXPECT_TRUE(
      refuses(AxisDynamics::make({.mass = nan, .viscous = 0, .coulomb = 0}, {}), "tip mass"));
  EXPECT_TRUE(refuses(AxisDynamics::make({.mass = 1, .viscous = -1, .coulomb = 0}, {}),
                      "viscous friction"));
  EXPECT_TRUE(refuses(AxisDynamics::make({.mass = 1, .viscous = 0, .coulomb = nan}, {}),
                      "Coulomb friction"));
  HandSettings hand;
  hand.mass = -1;
  EXPECT_TRUE(refuses(AxisDynamics::make(good, hand), "hand mass"));
  hand = {};
  hand.stiffness = -1;
  EXPECT_TRUE(refuses(AxisDynamics::make(good, hand), "hand stiffness"));
  hand = {};
  hand.damping = nan;
  EXPECT_TRUE(refuses(AxisDynamics::make(good, hand), "hand damping must be finite"));
  EXPECT_TRUE(AxisDynamics::make(good, {}));
}

}  // namespace
}  // namespace thimble::device_sim
