// The laws in one dimension [PHYSICS 1], with only the plant's exact map and a sampled wall:
// evidence that the simulated arm behaves like a real one. The other laws: hard cases 1 to 8,
// tests/sim/hard_case_walls_test.cpp.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "plant/axis_dynamics.h"

namespace thimble::device_sim {
namespace {

// Throws a free mass against a one-sided sampled wall; the first sample is `phase` (0 to 1) of a
// period after the entry.
double restitution(double stiffness, std::int64_t period_ns, double phase) {
  AxisDynamics axis =
      AxisDynamics::make({.mass = 0.075, .viscous = 0.005, .coulomb = 0}, {}).value();
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

TEST(StabilityLaws, SampledWallFollowsTheRestitutionLaw) {
  EXPECT_NEAR(mean_restitution(1000, 1'000'000), 1.0936, 0.0011);  // [PHYSICS 1.5]
  EXPECT_NEAR(mean_restitution(1000, 1'000'000), law_of_restitution(1000, 1e-3), 0.0011);
  EXPECT_NEAR(mean_restitution(1000, 250'000), law_of_restitution(1000, 0.25e-3), 0.0005);
  EXPECT_NEAR(mean_restitution(1000, 125'000), law_of_restitution(1000, 0.125e-3), 0.0003);
  EXPECT_NEAR(mean_restitution(3000, 1'000'000), 1.168, 0.0025);  // [PHYSICS 1.5]
}

}  // namespace
}  // namespace thimble::device_sim
