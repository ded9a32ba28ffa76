#pragma once

#include <cmath>

#include "thimble/driver/result.h"

namespace thimble::stability {

/// Factor between successive walls [chosen: narrower bands that grow below the edge are skipped].
inline constexpr double kWallRaised = 1.15;

/// Returns the stiffest wall, N/m, to 1 %, before the first of the raised ones that does not come
/// to rest. The stiffness is raised from `low`, which is assumed to rest, by factors of
/// `kWallRaised` up to `most`, and bisected in the last step. If all rest, the edge is up to 1.33
/// times `most`. `rests(stiffness)` returns a `driver::Result<bool>`. Bisection of the whole range
/// would suffice for a linear loop, but walls of a real arm beyond the edge may rest again. Fails
/// like `rests`.
template <class Rests>
driver::Result<double> raised_edge(double low, double max, const Rests& rests) {
  for (; low < max; low *= kWallRaised) {
    const driver::Result<bool> rest = rests(low * kWallRaised);
    if (!rest) return rest.error();
    if (!*rest) break;
  }
  for (double high = low * kWallRaised; high > 1.01 * low;) {
    const double middle = std::sqrt(low * high);
    const driver::Result<bool> rest = rests(middle);
    if (!rest) return rest.error();
    (*rest ? low : high) = middle;
  }
  return low;
}

}  // namespace thimble::stability
