#include "plant/axis_response.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "support/random.h"

namespace thimble::device_sim {
namespace {

// The closed forms in extended precision, one per damping regime; AxisResponse uses a different
// method.
long double exact_impulse(long double damping, long double stiffness, long double t) {
  const long double gamma = damping / 2, square = gamma * gamma - stiffness;
  const long double decay = std::exp(-gamma * t);
  if (square > 0) return decay * std::sinh(std::sqrt(square) * t) / std::sqrt(square);
  if (square < 0) return decay * std::sin(std::sqrt(-square) * t) / std::sqrt(-square);
  return decay * t;
}

TEST(AxisResponse, EqualsTheClosedFormInEveryRegime) {
  support::Random random(1);
  for (int i = 0; i < 20000; ++i) {
    const double damping = std::pow(10.0, random.uniform(-3, 4));
    const double stiffness = std::pow(10.0, random.uniform(-3, 8));
    const double t = std::pow(10.0, random.uniform(-6, -2));
    const AxisResponse response = AxisResponse::at(damping, stiffness, t);
    const auto expected = static_cast<double>(exact_impulse(damping, stiffness, t));
    const double rounding = 1e-15 * (1 + 8 * t * std::max(damping, std::sqrt(stiffness)));
    ASSERT_NEAR(response.impulse, expected, rounding * t)
        << damping << " " << stiffness << " " << t;
    // The equation itself, integrated once: S' + damping S + stiffness (integral of S) = 1.
    ASSERT_NEAR(response.slope + damping * response.impulse + stiffness * response.integral, 1,
                4 * rounding * (1 + damping * t + stiffness * t * t));
    // ... and twice: S + damping (integral) + stiffness (double integral) = t.
    ASSERT_NEAR(response.impulse + damping * response.integral + stiffness * response.second, t,
                4 * rounding * t * (1 + damping * t + stiffness * t * t));
  }
}

TEST(AxisResponse, IsContinuousAcrossCriticalDamping) {
  const double damping = 200, t = 1e-3;
  const AxisResponse critical = AxisResponse::at(damping, 1e4, t);
  EXPECT_NEAR(critical.impulse, t * std::exp(-100 * t), 1e-18);
  for (const double nudge : {1e-15, 1e-12, 1e-9}) {
    for (const double sign : {-1.0, 1.0}) {
      const AxisResponse near = AxisResponse::at(damping, 1e4 * (1 + sign * nudge), t);
      // d S / d stiffness is about -t^3 / 6.
      EXPECT_NEAR(near.impulse, critical.impulse, 1e4 * nudge * t * t * t + 2e-19);
    }
  }
}

TEST(AxisResponse, IsPolynomialForAFreeMass) {
  const AxisResponse response = AxisResponse::at(0, 0, 0.5);
  EXPECT_DOUBLE_EQ(response.slope, 1);
  EXPECT_DOUBLE_EQ(response.impulse, 0.5);
  EXPECT_DOUBLE_EQ(response.integral, 0.125);
  EXPECT_DOUBLE_EQ(response.second, 0.125 / 6);
}

TEST(AxisResponse, ConsecutiveStepsEqualTheirSumWithinRounding) {
  support::Random random(2);
  for (int i = 0; i < 10000; ++i) {
    const double damping = random.uniform(0, 300), stiffness = random.uniform(0, 1e5);
    const AxisMotion m{random.uniform(-1, 1), random.uniform(-50, 50), random.uniform(-500, 500),
                       damping, stiffness};
    const double first = random.uniform(0, 2e-3), second = random.uniform(0, 2e-3);
    const AxisResponse r1 = AxisResponse::at(damping, stiffness, first);
    const AxisMotion later{m.velocity(r1), m.acceleration(r1), m.jerk, damping, stiffness};
    const AxisResponse r2 = AxisResponse::at(damping, stiffness, second);
    const AxisResponse whole = AxisResponse::at(damping, stiffness, first + second);
    ASSERT_NEAR(m.way(r1) + later.way(r2), m.way(whole), 1e-17);
    ASSERT_NEAR(later.velocity(r2), m.velocity(whole), 4e-15);
    ASSERT_NEAR(later.acceleration(r2), m.acceleration(whole), 2e-12);
  }
}

TEST(AxisResponse, SurvivesExtremeConstants) {
  for (const double damping : {0.0, 1e-300, 1.0, 1e9}) {
    for (const double stiffness : {0.0, 1e-300, 1.0, 1e15}) {
      const AxisResponse response = AxisResponse::at(damping, stiffness, 1e-3);
      EXPECT_TRUE(std::isfinite(response.slope + response.impulse + response.second));
      EXPECT_LE(std::abs(response.slope), 1 + 1e-9);
      EXPECT_LE(std::abs(response.impulse), 1e-3 * (1 + 1e-9));
    }
  }
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(std::isfinite(AxisResponse::at(infinity, 1, 1e-3).impulse));
}

}  // namespace
}  // namespace thimble::device_sim
