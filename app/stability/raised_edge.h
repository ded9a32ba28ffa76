#pragma once

#include <cmath>

#include "thimble/driver/result.h"

namespace thimble::stability {

/// By how much a wall is raised at a time [chosen: narrower dips below the edge are stepped over].
inline constexpr double kWallRaised = 1.15;

/// Finds the stiffest wall, N/m, to 1 %, before the first of the raised ones that does not rest:
/// raised from `low`, which is taken to rest, by `kWallRaised` at a time up to `most`, and halved
/// in the last step; where all rest, the edge is up to 1.33 times `most`. `rests(stiffness)`
/// returns a `driver::Result<bool>`. Halving the whole range would do for a loop that is linear; as
/// an arm is, walls beyond the edge may rest again. Fails as `rests`.
template <class Rests>
driver::Result<double> raised_edge(double low, double most, const Rests& rests) {
  for (; low < most; low *= kWallRaised) {
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
