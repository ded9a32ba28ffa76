#include "studies/accuracy/pushed_arm.h"

#include <cmath>
#include <complex>
#include <cstddef>

#include "stability/draw.h"

namespace thimble::studies {
namespace {

// Advances by a tick: m v' = f - b v - c sgn v in closed form, including the time at which v
// becomes zero.
struct LongMotion {
  long double x = 0, v = 0;
};

LongMotion slide(long double x, long double v, long double f) {
  const long double m = PushedArm::kMass;
  const long double b = PushedArm::kViscous;
  const long double c = PushedArm::kCoulomb;
  long double left = PushedArm::kTick;
  for (int event = 0; event < 4 && left > 0; ++event) {
    if (v == 0 && std::abs(f) <= c) break;
    const long double sign = v != 0 ? (v > 0 ? 1 : -1) : (f > 0 ? 1 : -1);
    const long double u = (f - c * sign) / b;  // m/s, terminal speed
    // v + (u - v) (1 - exp(-b t / m)) = 0, if u has the other sign.
    long double t = left;
    bool stops = false;
    if (v != 0 && u * sign < 0) {
      const long double stop = -m / b * std::log(u / (u - v));
      if (stop < left) {
        t = stop;
        stops = true;
      }
    }
    const long double fade = -std::expm1(-b * t / m);
    x += u * t + (v - u) * m / b * fade;
    v = stops ? 0 : v + (u - v) * fade;
    left -= t;
  }
  return {x, v};
}

LineMotion rounded(const LongMotion& at) {
  return {static_cast<double>(at.x), static_cast<double>(at.v)};
}

}  // namespace

const std::vector<double>& pushing_forces() {
  static const std::vector<double> all = [] {
    std::vector<double> list;
    stability::Draw draw(9);
    while (list.size() < PushedArm::kTicks) {
      const double force = draw.uniform(-0.25, 0.25);
      const auto ticks = static_cast<std::size_t>(draw.uniform(20, 60));
      for (std::size_t i = 0; i < ticks && list.size() < PushedArm::kTicks; ++i) {
        list.push_back(force);
      }
    }
    return list;
  }();
  return all;
}

std::vector<LineMotion> pushed_with_dry_friction() {
  std::vector<LineMotion> way;
  LongMotion now;
  for (const double f : pushing_forces()) {
    now = slide(now.x, now.v, f);
    way.push_back(rounded(now));
  }
  return way;
}

std::vector<LineMotion> pushed_in_hand() {
  using Complex = std::complex<long double>;
  std::vector<LineMotion> way;
  const long double stiffness = PushedArm::kHandStiffness;
  const long double mass = PushedArm::kMass;
  const long double decay = (PushedArm::kViscous + PushedArm::kHandDamping) / (2 * mass);
  // x = f / k + re(A exp(s t)).
  const long double omega = std::sqrt(stiffness / mass - decay * decay);
  const Complex root(-decay, omega);
  const Complex turn = std::exp(root * static_cast<long double>(PushedArm::kTick));
  LongMotion now;
  for (const double f : pushing_forces()) {
    const long double rest = f / stiffness;
    const Complex amplitude(now.x - rest, -(now.v + decay * (now.x - rest)) / omega);
    const Complex next = amplitude * turn;
    now = {rest + next.real(), (next * root).real()};
    way.push_back(rounded(now));
  }
  return way;
}

}  // namespace thimble::studies
