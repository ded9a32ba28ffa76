// The laws of STABILITY in one dimension, with nothing but the plant's exact map and a sampled
// wall: evidence that the simulated arm shows what a real one would.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "thimble/device_sim/axis_dynamics.h"

namespace thimble::device_sim {
namespace {

// Throws a free mass against a one-sided sampled wall; the first sample falls `phase` (0 to 1) of a
// period after the entry.
double restitution(double stiffness, std::int64_t period_ns, double phase) {
  AxisDynamics axis({.mass = 0.075, .viscous = 0.005, .coulomb = 0}, {});
  AxisState state{.x = 0, .v = -0.1};
  axis.step(state, {}, static_cast<std::int64_t>(phase * static_cast<double>(period_ns)));
  for (int k = 0; k < 10000 && state.x <= 0; ++k) {
    axis.step(state, {.force = -stiffness * state.x}, period_ns);
  }
  return state.v / 0.1;
}

double mean_restitution(double stiffness, std::int64_t period_ns) {
  constexpr int kPhases = 400;
  double sum = 0;
  for (int i = 0; i < kPhases; ++i) sum += restitution(stiffness, period_ns, (i + 0.5) / kPhases);
  return sum / kPhases;
}

double law_of_restitution(double stiffness, double period) {
  return std::exp(-std::numbers::pi * (0.005 - stiffness * period / 2) /
                  (2 * std::sqrt(stiffness * 0.075)));
}

TEST(StabilityLaws, SampledWallReturnsTheEnergyThatTheRestitutionLawSays) {
  EXPECT_NEAR(mean_restitution(1000, 1'000'000), 1.0936, 0.0011);  // [STABILITY 1.5]
  EXPECT_NEAR(mean_restitution(1000, 1'000'000), law_of_restitution(1000, 1e-3), 0.0011);
  EXPECT_NEAR(mean_restitution(1000, 250'000), law_of_restitution(1000, 0.25e-3), 0.0005);
  EXPECT_NEAR(mean_restitution(1000, 125'000), law_of_restitution(1000, 0.125e-3), 0.0003);
  EXPECT_NEAR(mean_restitution(3000, 1'000'000), 1.168, 0.0025);  // [STABILITY 1.5]
}

// A free device in a two-sided sampled spring with a late force: how much its swing grows from the
// second tenth of the run to the last.
double growth(double stiffness, std::int64_t period_ns, std::int64_t delay_ns) {
  AxisDynamics axis({.mass = 0.075, .viscous = 1, .coulomb = 0}, {});
  AxisState state{.x = 1e-3, .v = 0};
  // The force of the sample k acts from k T + delay: whole periods are a queue, the rest cuts a
  // step.
  const auto whole = static_cast<std::size_t>(delay_ns / period_ns);
  const std::int64_t rest_ns = delay_ns % period_ns;
  std::array<double, 16> forces{};
  const auto steps = static_cast<int>(20'000'000'000 / period_ns);
  double early = 0, late = 0;
  for (int k = 0; k < steps; ++k) {
    forces[static_cast<std::size_t>(k) % 16] = -stiffness * state.x;
    const double now = forces[(static_cast<std::size_t>(k) + 16 - whole) % 16];
    const double before = forces[(static_cast<std::size_t>(k) + 15 - whole) % 16];
    axis.step(state, {.force = before}, rest_ns);
    axis.step(state, {.force = now}, period_ns - rest_ns);
    const double swing = 0.075 * state.v * state.v + stiffness * state.x * state.x;
    if (k >= steps / 10 && k < steps / 5) early = std::max(early, swing);
    if (k >= steps - steps / 10) late = std::max(late, swing);
  }
  return late / early;
}

TEST(StabilityLaws, StiffnessLimitFollowsTheLatencyBudget) {
  // Case 1 of [STABILITY 7]; b = 1 N s/m, no wall damping, K_max = b / (T/2 + delay) within 3 %.
  for (const std::int64_t period_ns : {1'000'000, 500'000, 250'000}) {
    for (const std::int64_t half_periods : {0, 1, 2, 4}) {
      const std::int64_t delay_ns = half_periods * period_ns / 2;
      const double latency =
          (static_cast<double>(period_ns) / 2 + static_cast<double>(delay_ns)) * 1e-9;
      EXPECT_LT(growth(0.97 / latency, period_ns, delay_ns), 1) << period_ns << " " << delay_ns;
      EXPECT_GT(growth(1.03 / latency, period_ns, delay_ns), 1) << period_ns << " " << delay_ns;
    }
  }
}

// Swings a PHANTOM-like device with dry friction in a two-sided sampled spring; tells whether the
// swing has grown or died.
double final_speed(double stiffness, double start_speed) {
  AxisDynamics axis({.mass = 0.075, .viscous = 0.005, .coulomb = 0.04}, {});
  AxisState state{.x = 0, .v = start_speed};
  double fastest = 0;
  for (int k = 0; k < 3000; ++k) {
    axis.step(state, {.force = -stiffness * state.x}, 1'000'000);
    if (k >= 2900) fastest = std::max(fastest, std::abs(state.v));
    if (std::abs(state.v) > 10) return 10;
  }
  return fastest;
}

TEST(StabilityLaws, DryFrictionHoldsASwingUpToItsLimitSpeed) {
  // Case 6 of [STABILITY 7]: v* = (4/pi) c / (K T/2 - b).
  for (const double stiffness : {500.0, 1000.0, 2000.0}) {
    const double limit = 4 / std::numbers::pi * 0.04 / (stiffness * 0.5e-3 - 0.005);
    EXPECT_EQ(final_speed(stiffness, 0.9 * limit), 0) << stiffness;
    EXPECT_GT(final_speed(stiffness, 1.1 * limit), 2 * limit) << stiffness;
  }
}

}  // namespace
}  // namespace thimble::device_sim
