#include "stability/stability_laws.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>

#include "support/wall_laws.h"

// The values are those of [PHYSICS 1 and 2.3], which independent simulations have confirmed.

namespace thimble::stability {
namespace {

using support::passive_damping;
using support::place_of_wall;
using support::region_of;
using support::WallPlace;
using support::WallRegion;

constexpr double kMass = 0.075, kViscous = 0.005, kCoulomb = 0.04, kStep = 3e-5;

TEST(StabilityLaws, SumOfTheLatencyBudget) {
  EXPECT_DOUBLE_EQ(scene::latency_of({.period = 0.001}), 0.0005);
  EXPECT_DOUBLE_EQ(scene::latency_of({.period = 0.001, .delay = 0.002, .amplifier_lag = 0.0003}),
                   0.0028);
  // Exponential periods have a standard deviation equal to their mean: half the stiffness.
  EXPECT_DOUBLE_EQ(scene::latency_of({.period = 0.001, .period_spread = 0.001}), 0.001);
  // 10 of 1000 ticks take 10 ms: 396 -> 221 N/m, 44 % lost (b = 0.2 gives the 396).
  const double mean = 0.99e-3 + 0.01 * 10e-3, square = 0.99e-6 + 0.01 * 100e-6;
  const double spread = std::sqrt(square - mean * mean);
  const double jittered = scene::latency_of({.period = mean, .period_spread = spread});
  EXPECT_NEAR(0.0005 / jittered, 221.0 / 396, 0.03);
}

TEST(StabilityLaws, LagOfALowPassFollowsItsPole) {
  EXPECT_EQ(scene::low_pass_lag(0, 0.001), 0);
  const double a = 1 - std::exp(-2 * M_PI * 100 * 0.001);
  EXPECT_NEAR(scene::low_pass_lag(100, 0.001), 0.001 * (1 - a) / a, 1e-12);
  // A slow pole lags by its time constant.
  EXPECT_NEAR(scene::low_pass_lag(1, 1e-5), 1 / (2 * M_PI), 1e-5);
}

TEST(StabilityLaws, PassiveDampingFollowsColgateAndSchenkel) {
  EXPECT_NEAR(passive_damping(1000, 0, 0.001), 0.5, 1e-9);
  EXPECT_NEAR(passive_damping(1000, -0.3, 0.001), 0.8, 1e-9);
  EXPECT_NEAR(passive_damping(1000, 0.3, 0.001), 0.8, 1e-9);
  EXPECT_NEAR(passive_damping(1000, 0, 0.001, 0.001), 1.5, 1e-9);
  EXPECT_NEAR(passive_damping(1000, 0, 0.001, 0.002), 2.5, 1e-9);
  EXPECT_NEAR(passive_damping(1000, 0.5, 0.001, 0.001), 1.25, 1e-6);  // a sum would give 2
}

TEST(StabilityLaws, PassiveStiffnessOfAFriction) {
  for (const double delay : {0.0, 0.0005, 0.001, 0.003}) {
    for (const double damping : {-0.2, 0.0, 0.4}) {
      const double stiffness = passive_stiffness(2, damping, 0.001, delay);
      EXPECT_NEAR(passive_damping(stiffness, damping, 0.001, delay), 2, 1e-9) << delay << damping;
    }
  }
  EXPECT_EQ(passive_stiffness(0.1, 0.2, 0.001), 0);
  EXPECT_DOUBLE_EQ(passive_stiffness_quantised(kViscous, kCoulomb, kStep, 0.001), 10);
  EXPECT_NEAR(passive_stiffness_quantised(5, kCoulomb, kStep, 0.001), 2667, 0.5);
  EXPECT_DOUBLE_EQ(passive_stiffness_quantised(5, kCoulomb, 0, 0.001), 10'000);
}

TEST(StabilityLaws, PositionOfAWallInDiolaitisMap) {
  using enum WallRegion;
  for (const double d : {0.0, 1.0}) {
    EXPECT_EQ(region_of({0.52 + d, 0.52, d}), kComesToRest);
    EXPECT_EQ(region_of({0.52 + d, 0.48, d}), kFlickers);
    EXPECT_EQ(region_of({0.48 + d, 0.52, d}), kHoldsSmallOscillations);
    EXPECT_EQ(region_of({0.48 + d, 0.48, d}), kGrows);
  }
  const WallPlace place = place_of_wall(1000, 0.5, 0.03, kStep, 0.001, 0.002);
  EXPECT_DOUBLE_EQ(place.beta, 0.5);
  EXPECT_DOUBLE_EQ(place.sigma, 1);
  EXPECT_DOUBLE_EQ(place.delay_periods, 2);
  EXPECT_EQ(place_of_wall(1000, 0.5, 0.03, 0, 0.001).sigma,
            std::numeric_limits<double>::infinity());
  EXPECT_NEAR(oscillation_speed_limit(1000, kViscous, kCoulomb, 0.0005), 0.103, 0.0005);
  EXPECT_EQ(oscillation_speed_limit(9, kViscous, kCoulomb, 0.0005),
            std::numeric_limits<double>::infinity());
}

TEST(StabilityLaws, RestitutionOfAnImpact) {
  EXPECT_NEAR(restitution(1000, kViscous, kMass, 0.0005), 1.0939, 5e-5);
  EXPECT_NEAR(restitution(1000, kViscous, kMass, 0.0015), 1.3115, 5e-5);
  EXPECT_NEAR(restitution(3000, kViscous, kMass, 0.0005), 1.170, 6e-4);
  EXPECT_NEAR(restitution(1000, kViscous, kMass, 0.000125), 1.0220, 5e-5);
  EXPECT_NEAR(restitution(1000, kViscous, kMass, 0.0000625), 1.0105, 5e-5);
  EXPECT_NEAR(restitution(1000, 2 + kViscous, kMass, 0.0005), 0.761, 5e-4);
}

TEST(StabilityLaws, LengthOfABristle) {
  // 0.5 N, hand of 3 N s/m: the law without its factor gives 0.083 mm without delay, 0.582 mm at 3
  // ms.
  EXPECT_NEAR(bristle_length(0.5, 0.0005, 3.005, 0, 0), 1.5 * 0.083e-3, 0.5e-6);
  EXPECT_NEAR(bristle_length(0.5, 0.0035, 3.005, 0, 0), 1.5 * 0.582e-3, 1e-6);
  EXPECT_NEAR(bristle_length(0.5, 0.0005, 3.005, kStep, kCoulomb), 0.1875e-3, 1e-9);
  EXPECT_EQ(bristle_length(0.5, 0.0005, 3, kStep, 0), std::numeric_limits<double>::infinity());
}

TEST(SampledWall, EdgeEqualsLatencyBudgetWithinValidity) {
  for (const double period : {0.004, 0.001, 0.000125}) {
    for (const double delay : {0.0, 0.5, 1.0, 2.0}) {
      const SampledWall wall{
          .mass = kMass, .viscous = 0.2, .period = period, .delay = delay * period};
      const double law =
          scene::stiffness_limit(0.2, scene::latency_of({.period = period, .delay = wall.delay}));
      EXPECT_NEAR(stiffness_edge(wall) / law, 1, 0.03) << period << " " << delay;
    }
  }
  const SampledWall lagging{.mass = kMass, .viscous = 0.2, .period = 0.001, .amplifier_lag = 0.001};
  EXPECT_NEAR(stiffness_edge(lagging) / scene::stiffness_limit(0.2, 0.0015), 1, 0.03);
}

TEST(SampledWall, AmplifierLagActsLikeDelay) {
  for (const double lag : {0.0002, 0.0005, 0.001, 0.002}) {
    const SampledWall wall{.mass = kMass, .viscous = 0.2, .period = 0.001, .amplifier_lag = lag};
    EXPECT_NEAR(limit_by_phase(wall) / stiffness_edge(wall), 1, 0.01) << lag;
    const SampledWall late{.mass = kMass, .viscous = 0.2, .period = 0.001, .delay = lag};
    EXPECT_NEAR(stiffness_edge(late) / stiffness_edge(wall), 1, 0.01) << lag;
  }
}

TEST(SampledWall, EqualsRigidArmWithStiffCable) {
  SampledWall wall{.mass = kMass, .viscous = 1, .period = 0.001, .delay = 0.0015};
  const double mass = wall.mass;
  const double rigid = stiffness_edge(wall);
  EXPECT_NEAR(limit_by_phase(wall) / late_stiffness_limit(1, 0.002, mass), 1, 1e-3);
  wall.mass = 0.7 * mass;
  wall.rotor_mass = 0.3 * mass;
  wall.cable_damping = 5;
  wall.cable_stiffness = 1e7;
  EXPECT_NEAR(stiffness_edge(wall) / rigid, 1, 1e-3);
  EXPECT_NEAR(limit_by_phase(wall) / late_stiffness_limit(1, 0.002, mass), 1, 1e-3);
}

TEST(SampledWall, CableShiftsEdgeByTwoMassLaw) {
  // The same two masses with steps of 2 us instead of the exact map.
  const auto grows = [](const SampledWall& wall, double stiffness) {
    double x = 0, v = 0.01, rotor = 0, rate = 0.01, force = 0, early = 0, late = 0;
    const double h = 2e-6;
    const auto per_tick = static_cast<int>(std::lround(wall.period / h));
    const int ticks = 3000;
    for (int tick = 0; tick < ticks; ++tick) {
      force = -stiffness * rotor;
      double max = 0;
      for (int i = 0; i < per_tick; ++i) {
        const double cable = wall.cable_stiffness * (rotor - x) + wall.cable_damping * (rate - v);
        v += h * (cable - wall.viscous * v) / wall.mass;
        rate += h * (force - cable) / wall.rotor_mass;
        x += h * v;
        rotor += h * rate;
        max = std::max(max, std::abs(rotor));
      }
      if (tick >= ticks / 4 && tick < ticks / 2) early = std::max(early, max);
      if (tick >= 3 * ticks / 4) late = std::max(late, max);
      if (max > 1) return true;
    }
    return late > early;
  };
  for (const double cable : {2e3, 5e3, 2e4, 2e5}) {
    const SampledWall wall{.mass = kMass,
                           .viscous = 1,
                           .period = 0.001,
                           .cable_stiffness = cable,
                           .cable_damping = 1,
                           .rotor_mass = 0.3 * kMass};
    const double edge = stiffness_edge(wall);
    EXPECT_FALSE(grows(wall, 0.97 * edge)) << cable;
    EXPECT_TRUE(grows(wall, 1.03 * edge)) << cable;
    EXPECT_NEAR(limit_by_phase(wall) / edge, 1, 0.01) << cable;
  }
}

// From 4.4 to 7.1 kN/m the motor oscillates against the tip; up to 10.2 kN/m it rests again.
TEST(SampledWall, WithCableIsUnstableFromFirstBandOn) {
  SampledWall wall{.mass = 0.7 * 0.075,
                   .viscous = 1,
                   .period = 0.001,
                   .cable_stiffness = 9441,
                   .cable_damping = 3,
                   .rotor_mass = 0.3 * 0.075};
  const double edge = stiffness_edge(wall);
  EXPECT_NEAR(edge / limit_by_phase(wall), 1, 0.01);
  wall.stiffness = 1.3 * edge;
  EXPECT_GT(growth_per_tick(wall), 1);
  wall.stiffness = 2 * edge;
  EXPECT_LT(growth_per_tick(wall), 1);
}

TEST(SampledWall, VelocityLowPassLowersTheEdge) {
  // B = 2 N s/m, simulated [PHYSICS 1.1]; the exact map agrees within 0.3 %.
  SampledWall wall{.mass = kMass, .viscous = kViscous, .damping = 2, .period = 0.001};
  for (const auto& [corner, edge] :
       {std::pair(0.0, 3902.0), {100.0, 3412.0}, {50.0, 2692.0}, {30.0, 2016.0}}) {
    wall.velocity_corner = corner;
    EXPECT_NEAR(stiffness_edge(wall) / edge, 1, 0.003) << corner;
  }
}

}  // namespace
}  // namespace thimble::stability
