#include "compact_mesh/surface_rise.h"

#include <algorithm>

#include "compact_mesh/unpack_triangle.h"

namespace thimble::render {

using namespace unpacked;

double rise_above(std::span<const PackedTriangle> triangles) noexcept {
  constexpr double kFelt = 1e-5 * 2 * kLatticeHalf;
  // The sum over pairs is at most a third of the largest bulge. Where corners are not creases, 1 +
  // |sum l_i n_i| is above 5/3.
  __m128 most = _mm_setzero_ps();
  for (const PackedTriangle& r : triangles) {
    const Sides x(r.x.data()), y(r.y.data()), z(r.z.data());
    most = _mm_max_ps(most, bulges(x, y, z, unpack_normals(r)));
  }
  const double rise = std::max(std::max(first(most), first(all<1>(most))), first(all<2>(most))) / 5;
  return rise > kFelt ? rise : 0;
}

}  // namespace thimble::render
