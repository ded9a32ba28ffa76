#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

namespace thimble::support {

// Laws of [PHYSICS 1.2, 1.4 and 1.5] for comparison with simulated walls; symbols as in
// stability/stability_laws.h.

/// Returns the smallest viscous friction of a device, N s/m, with which a wall is passive for any
/// passive hand: max over angles of (K T / 2) sin((d + 1/2) a) / sin(a / 2) - B cos((1 + d) a)
/// [PHYSICS 1.2].
inline double passive_damping(double stiffness, double damping, double period, double delay = 0) {
  constexpr int kAngles = 20'000;
  const double d = delay / period;
  double max = -std::numeric_limits<double>::infinity();
  for (int i = 0; i <= kAngles; ++i) {
    const double a = std::numbers::pi * i / kAngles;
    const double ratio = i > 0 ? std::sin((d + 0.5) * a) / std::sin(0.5 * a) : 2 * d + 1;
    max = std::max(max, 0.5 * stiffness * period * ratio - damping * std::cos((1 + d) * a));
  }
  return max;
}

/// Response of a wall after any start [PHYSICS 1.4, Diolaiti et al.].
enum class WallRegion {
  kComesToRest,             ///< From every start.
  kFlickers,                ///< Ends in a limit cycle of a few encoder counts.
  kHoldsSmallOscillations,  ///< Comes to rest from slow starts, grows above
                            ///< oscillation_speed_limit.
  kGrows,                   ///< Flickers, then grows.
};

/// Position of a wall in the map of [PHYSICS 1.4]: beta = b / (K T), sigma = c / (K d).
struct WallPlace {
  double beta = 0;
  double sigma = 0;
  double delay_periods = 0;
};

/// Returns the position of a wall in the map. Without encoder steps sigma is infinite.
inline WallPlace place_of_wall(double stiffness, double viscous, double coulomb,
                               double encoder_step, double period, double delay = 0) {
  return {.beta = viscous / (stiffness * period),
          .sigma = encoder_step > 0 ? coulomb / (stiffness * encoder_step)
                                    : std::numeric_limits<double>::infinity(),
          .delay_periods = delay / period};
}

/// Returns the response of a wall at this position; the corners are at beta = 1/2 + d and sigma =
/// 1/2.
inline WallRegion region_of(const WallPlace& place) {
  const bool damped = place.beta > 0.5 + place.delay_periods;
  if (place.sigma > 0.5)
    return damped ? WallRegion::kComesToRest : WallRegion::kHoldsSmallOscillations;
  return damped ? WallRegion::kFlickers : WallRegion::kGrows;
}

/// Returns the mean restitution of an impact of a free mass as exp(pi Re s / Im s), from the
/// slowest root s of m s^2 + b s + K e^{-s L} = 0. It includes the effect of the latency on the
/// period of the oscillation. For K L^2 / m up to 0.5; stability::restitution is 1 % off at 0.08.
inline double late_restitution(double stiffness, double damping, double mass, double latency) {
  std::complex<double> s(0, std::sqrt(stiffness / mass));
  for (int i = 0; i < 50; ++i) {
    const std::complex<double> late = stiffness * std::exp(-s * latency);
    s -= (mass * s * s + damping * s + late) / (2 * mass * s + damping - latency * late);
  }
  return std::exp(std::numbers::pi * s.real() / s.imag());
}

}  // namespace thimble::support
