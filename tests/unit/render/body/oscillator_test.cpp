#include "body/spring/oscillator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include "support/hard_case.h"
#include "support/random.h"

namespace thimble::render {
namespace {

using Complex = std::complex<long double>;

struct Motion {
  long double x, v;
};

// Returns the textbook's closed form, with complex roots; the double root by its own formula.
Motion closed_form(double mass, double stiffness, double damping, long double t, long double x0,
                   long double v0, long double f) {
  const long double m = mass, k = stiffness, b = damping;
  const long double rest = f / k;
  const long double a = b / (2 * m);
  const long double d = a * a - k / m;
  const long double y0 = x0 - rest;
  // At zeta = 1 the rounding of b leaves d of about 1e-16 a^2, where the two roots would cancel.
  // The double root is then exact to d t^2 / 6, below 1e-16.
  if (std::abs(d) < 1e-14L * a * a) {
    const long double e = std::exp(-a * t);
    const long double c = v0 + a * y0;
    return {rest + e * (y0 + c * t), e * (c - a * (y0 + c * t))};
  }
  const Complex s = std::sqrt(Complex(d, 0));
  const Complex r1 = -a - s;
  const Complex r2 = Complex(k / m, 0) / r1;
  const Complex c1 = (v0 - r2 * y0) / (r1 - r2);
  const Complex c2 = y0 - c1;
  const Complex e1 = c1 * std::exp(r1 * t);
  const Complex e2 = c2 * std::exp(r2 * t);
  return {rest + (e1 + e2).real(), (r1 * e1 + r2 * e2).real()};
}

// Calls `visit` for k 10 to 1e5 N/m, m 1 mg to 10 g, h 0.125 to 30 ms and dampings around critical.
template <class Visit>
void for_all(Visit&& visit) {
  for (const double k : {10.0, 47.0, 300.0, 1e3, 8e3, 1e5}) {
    for (const double m : {1e-6, 2e-5, 3e-4, 1e-3, 1e-2}) {
      for (const double h : {0.125e-3, 0.25e-3, 1e-3, 4e-3, 30e-3}) {
        for (const double zeta : {0.0, 1e-3, 0.1, 0.9, 0.999999, 1.0, 1.000001, 1.2, 5.0, 300.0}) {
          visit(k, m, h, 2 * zeta * std::sqrt(k * m));
        }
      }
    }
  }
}

TEST(HardCaseOscillator, StepMatchesTheClosedForm) {
  support::Random random(29);
  double worst = 0;
  for_all([&](double k, double m, double h, double b) {
    const double omega = std::sqrt(k / m);
    const double x0 = random.uniform(-1e-3, 1e-3);
    const double v0 = random.uniform(-1e-3, 1e-3) * omega;
    const double f = random.uniform(-1e-3, 1e-3) * k;
    const Motion truth = closed_form(m, k, b, h, x0, v0, f);
    double x = x0;
    double v = v0;
    OscillatorStep::of(m, k, b, h).apply(x, v, f);
    // Relative to the size of the motion due to x, v and f together.
    const double size = std::abs(x0) + std::abs(v0) / omega + std::abs(f) / k;
    worst = std::max({worst, std::abs(static_cast<double>(x - truth.x)) / size,
                      std::abs(static_cast<double>(v - truth.v)) / (size * omega)});
  });
  EXPECT_LT(worst, 1e-12);
  support::record_hard_case(29, "k 10 to 1e5 N/m, m 1 mg to 10 g, h 0.125 to 30 ms, any damping",
                            "< error of the closed form", worst, 1e-12, "1");
}

TEST(HardCaseOscillator, StepNeverGainsEnergy) {
  double most = 0;
  for_all([&](double k, double m, double h, double b) {
    const OscillatorStep step = OscillatorStep::of(m, k, b, h);
    double x = 1e-3;
    double v = 0;
    const double before = k * x * x;
    for (int i = 0; i < 200; ++i) {
      step.apply(x, v, 0.0);
      ASSERT_LE(k * x * x + m * v * v, before * (1 + 1e-12)) << k << " " << m << " " << h;
      most = std::max(most, (k * x * x + m * v * v) / before);
    }
  });
  support::record_hard_case(29, "the same, 200 steps from rest", "<= growth of the energy",
                            most - 1, 1e-12, "1");
}

TEST(OscillatorStep, HoldsWithoutSpringOrDamper) {
  double x = 1;
  double v = 2;
  OscillatorStep::of(0.5, 0, 0, 0.1).apply(x, v, 3.0);
  EXPECT_DOUBLE_EQ(x, 1 + 2 * 0.1 + 0.5 * 6 * 0.01);
  EXPECT_DOUBLE_EQ(v, 2 + 6 * 0.1);
  // Only a damper: v approaches f / b, and the distance is that of the textbook.
  for (const double b : {1e-9, 0.3, 40.0, 1e6}) {
    const double m = 0.5, h = 0.1;
    const long double tau = m / static_cast<long double>(b);
    const long double gone = -std::expm1(-h / tau);
    x = 1;
    v = 2;
    OscillatorStep::of(m, 0, b, h).apply(x, v, 3.0);
    const long double rest = 3.0L / b;
    EXPECT_NEAR(v, static_cast<double>(rest * gone + 2 * (1 - gone)), 1e-12 * (2 + 1e-3)) << b;
    if (b > 0.1) {
      EXPECT_NEAR(x, static_cast<double>(1 + rest * h + (2 - rest) * tau * gone), 1e-12) << b;
    }
  }
}

TEST(OscillatorStep, IsTheSameOnBothSidesOfEachOfItsBranches) {
  // A change of damping or step by 1e-9 must not have a larger effect.
  support::Random random(3);
  for (int i = 0; i < 2000; ++i) {
    const double zeta = random.uniform(0.5, 2.5);
    const double phase = random.uniform(0.2, 3);
    const double k = 500, m = 1e-3;
    const double h = phase / std::sqrt(k / m);
    const double b = 2 * zeta * std::sqrt(k * m);
    const OscillatorStep one = OscillatorStep::of(m, k, b, h);
    const OscillatorStep other = OscillatorStep::of(m, k, b * (1 + 1e-9), h * (1 + 1e-9));
    EXPECT_NEAR(one.xx, other.xx, 3e-8);
    EXPECT_NEAR(one.vv, other.vv, 3e-8);
    EXPECT_NEAR(one.xf * k, other.xf * k, 3e-8);
  }
}

TEST(OscillatorStep, IgnoresInvalidInput) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, inf, -1.0}) {
    for (int which = 0; which < 4; ++which) {
      double p[4] = {1e-3, 500, 0.1, 1e-3};
      p[which] = bad;
      double x = 2e-3;
      double v = 7;
      OscillatorStep::of(p[0], p[1], p[2], p[3]).apply(x, v, 1.0);
      EXPECT_EQ(x, 2e-3);
      EXPECT_EQ(v, 0);
    }
  }
  double x = 2e-3;
  double v = 7;
  OscillatorStep::of(1e-6, 1e12, 1e9, 10).apply(x, v, 0.0);
  EXPECT_LE(std::abs(x), 2e-3);
}

}  // namespace
}  // namespace thimble::render
