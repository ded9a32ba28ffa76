#include "track/swept_contact.h"

#include <algorithm>

#include "mesh/exact_sign.h"
#include "mesh/segment_crossing.h"

namespace thimble::render {

using Eigen::Vector3d;

int swept_over(const Vector3d& p, const Vector3d& p_far, const Vector3d& a, const Vector3d& b,
               const Vector3d& c, const Vector3d& a_then) noexcept {
  for (int i = 0; i < 3; ++i) {
    // Written so that NaN counts as not swept over.
    if (!(p[i] >= std::min({a[i], b[i], c[i], a_then[i]}))) return 0;
    if (!(p[i] <= std::max({a[i], b[i], c[i], a_then[i]}))) return 0;
  }
  // The triangle sweeps a tetrahedron. The sides that triangles share at a vertex are
  // bit-identical.
  const auto crosses = [&](const Vector3d& x, const Vector3d& y, const Vector3d& z) noexcept {
    return crossing(p, p_far, x, y, z) == Crossing::kNone ? 0 : 1;
  };
  const int crossings =
      crosses(a, b, c) + crosses(a_then, b, c) + crosses(a, a_then, b) + crosses(a, a_then, c);
  return crossings % 2 == 1 ? orientation(a, b, c, a_then) : 0;
}

}  // namespace thimble::render
