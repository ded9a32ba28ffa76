#include "thimble/render/body/spring_scheme.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace thimble::render {
namespace {

constexpr double kAnyStep = std::numeric_limits<double>::infinity();

// For a vector u of unit mass, k = u.Ku and c = u.Cu, each scheme's growth factors solve a
// quadratic with real coefficients. Its roots stay in the unit circle under the conditions below.

// s^2 + c s + k = 0 with |1 + h s| <= 1: h <= c / k if s is complex, h <= 2 / |s| if it is real,
// and |s| <= c. c / k is at least the least ratio of any spring, and at least the least c over the
// largest k.
double explicit_euler(const NetworkBounds& bounds) {
  const double stiffest = bounds.omega_max * bounds.omega_max;
  const double by_nodes = stiffest > 0 ? bounds.damping_rate_min / stiffest : kAnyStep;
  const double by_damping = bounds.damping_rate_max > 0 ? 2 / bounds.damping_rate_max : kAnyStep;
  return std::min(std::max(bounds.relaxation_min, by_nodes), by_damping);
}

// 2 c h + k h^2 <= 4.
double symplectic_euler(const NetworkBounds& bounds) {
  const double c = bounds.damping_rate_max;
  const double k = bounds.omega_max * bounds.omega_max;
  const double root = c + std::sqrt(c * c + 4 * k);
  return root > 0 ? 4 / root : kAnyStep;
}

// c h <= 2 and k h^2 <= (4 - 2 ch + c^2h^2) / (1 - ch / 2), which is at least 4 there.
double verlet(const NetworkBounds& bounds) {
  const double fastest = std::max(bounds.omega_max, bounds.damping_rate_max);
  return fastest > 0 ? 2 / fastest : kAnyStep;
}

}  // namespace

std::string_view name_of(SpringScheme scheme) noexcept {
  switch (scheme) {
    case SpringScheme::kExplicitEuler:
      return "explicit_euler";
    case SpringScheme::kSymplecticEuler:
      return "symplectic_euler";
    case SpringScheme::kVerlet:
      return "verlet";
    case SpringScheme::kImplicitEuler:
      return "implicit_euler";
    case SpringScheme::kTrapezoid:
      return "trapezoid";
    case SpringScheme::kExponential:
      return "exponential";
    case SpringScheme::kModal:
      return "modal";
  }
  return "unknown";
}

double largest_step(SpringScheme scheme, const NetworkBounds& bounds) noexcept {
  switch (scheme) {
    case SpringScheme::kExplicitEuler:
      return explicit_euler(bounds);
    case SpringScheme::kSymplecticEuler:
      return symplectic_euler(bounds);
    case SpringScheme::kVerlet:
      return verlet(bounds);
    case SpringScheme::kImplicitEuler:
    case SpringScheme::kTrapezoid:
    case SpringScheme::kExponential:
    case SpringScheme::kModal:
      break;
  }
  return kAnyStep;
}

}  // namespace thimble::render
