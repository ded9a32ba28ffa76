#include "search/eight_triangles.h"

#include <cmath>

#include "compact_mesh/wide_lanes.h"
#include "search/lanes.h"

namespace thimble::render {

using Eigen::Vector3d;

void EightTriangles::set(std::size_t lane, const std::array<Vector3d, 3>& corners) noexcept {
  for (std::size_t k = 0; k < 3; ++k) {
    const auto unit = [&](int axis) {
      return static_cast<std::int16_t>(std::lrint(corners[k][axis]));
    };
    x[k][lane] = unit(0);
    y[k][lane] = unit(1);
    z[k][lane] = unit(2);
  }
}

// A corner is half a unit off. Corner and query are also rounded relative to the middle of a volume
// in single precision: less than 2^-8 units within the reach of corners. Beyond it the error is a
// share that the tests of eight triangles take into account.
constexpr double kCorner = 0.5 + 0x1p-8;

SegmentInUnits segment_in_units(const Vector3d& way, double rounding, double per_step) noexcept {
  const Vector3d units = per_step * way;
  const double off = per_step * rounding;
  return {
      {static_cast<float>(units.x()), static_cast<float>(units.y()), static_cast<float>(units.z())},
      static_cast<float>(units.cwiseAbs().maxCoeff()),
      static_cast<float>(2 * off),
      static_cast<float>(kCorner + off)};
}

NearestInUnits nearest_in_units(double farthest, double rounding, double per_step) noexcept {
  // A little more, for the rounding to single precision.
  return {.far = static_cast<float>(per_step * farthest * (1 + 0x1p-22)),
          .wrong = static_cast<float>(kCorner + per_step * rounding)};
}

unsigned nearer_of_eight(const NearestInUnits& nearest, const Vector3d& from,
                         const EightTriangles& eight) noexcept {
  return wide_lanes() ? lanes_avx2::nearer_of_eight(nearest, from.data(), eight)
                      : lanes_plain::nearer_of_eight(nearest, from.data(), eight);
}

unsigned measure_eight(NearestInUnits& nearest, const Vector3d& from, const EightTriangles& eight,
                       unsigned there, float* low) noexcept {
  return wide_lanes() ? lanes_avx2::measure_eight(nearest, from.data(), eight, there, low)
                      : lanes_plain::measure_eight(nearest, from.data(), eight, there, low);
}

unsigned met_of_eight(const SegmentInUnits& segment, const Vector3d& from,
                      const EightTriangles& eight) noexcept {
  return wide_lanes() ? lanes_avx2::met_of_eight(segment, from.data(), eight)
                      : lanes_plain::met_of_eight(segment, from.data(), eight);
}

}  // namespace thimble::render
