#include "plant/axis_response.h"

#include <array>
#include <cmath>

namespace thimble::device_sim {
namespace {

constexpr int kMaxTerms = 17;

constexpr std::array<double, kMaxTerms + 3> inverse_factorials() {
  std::array<double, kMaxTerms + 3> inverse{};
  double factorial = 1;
  for (std::size_t n = 0; n < inverse.size(); ++n) {
    if (n > 0) factorial *= static_cast<double>(n);
    inverse[n] = 1 / factorial;
  }
  return inverse;
}
constexpr auto kInverseFactorial = inverse_factorials();

// Bounds of damping t and (stiffness t^2) for the series; the characteristic roots are then below
// 0.41 / t, and the 18th term is below 2^-56 of the sum.
constexpr double kDampingMax = 0.25, kStiffnessMax = 0.0625;
// Below these the roots are under 0.081 / t and twelve terms suffice.
constexpr double kSmallDamping = 0.03125, kSmallStiffness = 0.00390625;
constexpr int kSmallTerms = 12;

// Number of halvings that brings any finite pair of doubles below the bounds.
constexpr int kMaxHalvings = 1100;

AxisResponse series(double damping, double stiffness, double t) noexcept {
  const double alpha = damping * t, beta = stiffness * t * t;
  const int terms = alpha <= kSmallDamping && beta <= kSmallStiffness ? kSmallTerms : kMaxTerms;
  double before = 0, now = 1;
  double slope = 0, impulse = 0, integral = 0, second = 0;
  for (int n = 1; n <= terms; ++n) {
    const auto i = static_cast<std::size_t>(n);
    slope += now * kInverseFactorial[i - 1];
    impulse += now * kInverseFactorial[i];
    integral += now * kInverseFactorial[i + 1];
    second += now * kInverseFactorial[i + 2];
    const double next = -alpha * now - beta * before;
    before = now;
    now = next;
  }
  return {slope, impulse * t, integral * t * t, second * t * t * t};
}

}  // namespace

AxisResponse AxisResponse::at(double damping, double stiffness, double t) noexcept {
  int halvings = 0;
  while (halvings < kMaxHalvings &&
         (damping * t > kDampingMax || stiffness * t * t > kStiffnessMax)) {
    t *= 0.5;
    ++halvings;
  }
  AxisResponse now = series(damping, stiffness, t);
  // The state that the impulse leaves at t is propagated through t once more.
  for (; halvings > 0; --halvings) {
    const AxisResponse half = now;
    const double way = half.impulse + damping * half.integral;
    now.slope = half.slope * half.slope - stiffness * half.impulse * half.impulse;
    now.impulse = half.impulse * (2 * half.slope + damping * half.impulse);
    now.integral = half.integral * (1 + half.slope) + half.impulse * way;
    now.second = 2 * half.second + half.integral * (way + half.impulse);
  }
  return now;
}

}  // namespace thimble::device_sim
