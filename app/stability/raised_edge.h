#pragma once

#include <cmath>

#include "thimble/driver/result.h"

namespace thimble::stability {

/// Factor between two stiffnesses of the search [chosen: narrower unstable bands below the edge are
/// skipped].
inline constexpr double kWallRaised = 1.15;

/// Returns the largest stable stiffness, N/m, to 1 %, below the first unstable one found. The
/// stiffness is raised from `low`, which must be stable, by the factor `kWallRaised` up to `most`;
/// the last step is then bisected. If all are stable, the result is up to 1.33 times `most`.
/// `rests(stiffness)` returns a `driver::Result<bool>`. Bisecting the whole range would suffice for
/// a linear loop; with a real arm, stiffnesses beyond the edge may be stable again. Fails like
/// `rests`.
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
