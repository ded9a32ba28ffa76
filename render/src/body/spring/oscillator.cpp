#include "body/spring/oscillator.h"

#include <algorithm>
#include <cmath>

#include "math/wide.h"

namespace thimble::render {
namespace {

// Twice the bits of a double throughout: at k = 1e5 N/m, m = 1 mg and 30 ms the phase is 9,500 rad.
// Its rounding in double would be 1e-12. A long double differs between processors.
using Real = math::DoubleDouble;

// Per unit mass: x'' + 2 a x' + w2 x = g.
struct Rates {
  Real a;    // 1/s
  Real w2;   // 1/s^2
  double h;  // s
};

struct Flow {
  Real xx, xv, xf, vx, vv, vf;
};

// Below this phase and damping per step the series is short and loses no digits. It is also used
// where the spring is so soft that 1 - xx would lose digits.
constexpr double kSeriesPhase = 1.5;

// Sums the series of the matrix exponential: 3^40 / 40! is below 1e-28.
Flow by_series(const Rates& r) {
  constexpr int kTerms = 40;
  Flow flow{1, 0, 0, 0, 1, 0};
  // Columns of (A h)^n / n!, beginning with the unit vectors; the third is that of the force.
  Real x1 = 1, v1 = 0, x2 = 0, v2 = 1, x3 = 0, v3 = 0;
  for (int n = 1; n <= kTerms; ++n) {
    const Real s = r.h / static_cast<double>(n);
    const double held = n == 1 ? 1 : 0;
    const auto next = [&](Real& x, Real& v, Real push) {
      const Real x_new = s * v;
      v = s * (push - r.w2 * x - r.a * v * 2);
      x = x_new;
    };
    next(x1, v1, 0);
    next(x2, v2, 0);
    next(x3, v3, held);
    flow = {flow.xx + x1, flow.xv + x2, flow.xf + x3, flow.vx + v1, flow.vv + v2, flow.vf + v3};
  }
  return flow;
}

// Computes the flow from c = e^-ah cosh(sh), q = e^-ah sinh(sh) / s.
Flow from(const Rates& r, Real c, Real q) {
  const Real xx = c + r.a * q;
  return {xx, q, (1 - xx) / r.w2, -r.w2 * q, c - r.a * q, q};
}

// Near critical damping: cosh and sinh as series in (sh)^2, which may have either sign.
Flow near_critical(const Rates& r, Real squared) {
  constexpr int kTerms = 12;
  Real c = 0;
  Real q = 0;
  Real term = 1;
  for (int n = 0; n < kTerms; ++n) {
    c = c + term;
    term = term / (2.0 * n + 1);
    q = q + term;
    term = term * squared / (2.0 * n + 2);
  }
  const Real fade = math::wide_exp(-r.a * r.h);
  return from(r, fade * c, fade * q * r.h);
}

Flow over_damped(const Rates& r, Real s) {
  const Real fast = r.a + s;
  const Real slow = r.w2 / fast;  // a - s without its cancellation
  const Real fast_end = math::wide_exp(-fast * r.h);
  const Real slow_end = math::wide_exp(-slow * r.h);
  const Real way = slow.hi > 0 ? -math::wide_expm1(-slow * r.h) / slow : r.h;
  const Real two_s = s * 2;
  const Real q = (slow_end - fast_end) / two_s;
  return {(fast * slow_end - slow * fast_end) / two_s,          q,
          (way + math::wide_expm1(-fast * r.h) / fast) / two_s, -r.w2 * q,
          (fast * fast_end - slow * slow_end) / two_s,          q};
}

Flow flow_of(const Rates& r) {
  const Real w = r.w2.hi > 0 ? math::square_root(r.w2) : Real();
  if (std::max(r.a.hi, w.hi) * r.h < kSeriesPhase) return by_series(r);
  const Real d = (r.a - w) * (r.a + w);
  const Real squared = d * r.h * r.h;
  if (std::abs(squared.hi) < 1) return near_critical(r, squared);
  if (d.hi > 0) return over_damped(r, math::square_root(d));
  const Real s = math::square_root(-d);
  const Real fade = math::wide_exp(-r.a * r.h);
  const auto [sine, cosine] = math::wide_sine_cosine(s * r.h);
  return from(r, fade * cosine, fade * sine / s);
}

}  // namespace

OscillatorStep OscillatorStep::of(double mass, double stiffness, double damping,
                                  double step) noexcept {
  OscillatorStep stopped;
  stopped.vv = 0;
  const auto fine = [](double x) { return x >= 0 && std::isfinite(x); };
  if (!(mass > 0) || !std::isfinite(mass)) return stopped;
  if (!fine(stiffness) || !fine(damping) || !fine(step)) return stopped;
  const Real m = mass;
  const Flow flow = flow_of({damping / (m * 2), stiffness / m, step});
  return {flow.xx.hi, flow.xv.hi, (flow.xf / m).hi, flow.vx.hi, flow.vv.hi, (flow.vf / m).hi};
}

}  // namespace thimble::render
