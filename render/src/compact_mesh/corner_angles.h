#pragma once

#include <Eigen/Core>
#include <array>
#include <numbers>

#include "math/elementary.h"
#include "math/rough_arc.h"

namespace thimble::render {

/// Returns the angles of a triangle at its corners, the same as by `math::atan2` rounded to single
/// precision, but usually without its cost. Sides `ab` and `ac` in any unit, `twice_area` > 0 in
/// its square. Real-time: safe.
inline std::array<float, 3> corner_angles(const Eigen::Vector3d& ab, const Eigen::Vector3d& ac,
                                          double twice_area) noexcept {
  const double along_a = ab.dot(ac), along_b = -ab.dot(ac - ab);
  const math::RoughAngle a = math::rough_atan2(twice_area, along_a);
  const math::RoughAngle b = math::rough_atan2(twice_area, along_b);
  // Rounding is monotone: if the bounds of the angles round to the same values, so does everything
  // between.
  const auto rounded = [](const math::RoughAngle& at_a, const math::RoughAngle& at_b, double side) {
    const double first = at_a.angle + side * at_a.wrong, second = at_b.angle + side * at_b.wrong;
    return std::array<float, 3>{static_cast<float>(first), static_cast<float>(second),
                                static_cast<float>(std::numbers::pi - first - second)};
  };
  const std::array<float, 3> least = rounded(a, b, -1);
  if (least == rounded(a, b, 1)) return least;
  const double at_a = math::atan2(twice_area, along_a);
  const double at_b = math::atan2(twice_area, along_b);
  return {static_cast<float>(at_a), static_cast<float>(at_b),
          static_cast<float>(std::numbers::pi - at_a - at_b)};
}

}  // namespace thimble::render
