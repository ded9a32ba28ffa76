#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace thimble::compat::dhd {

/// Returns the angles a, b, c (rad) of a rotation R = Rx(a) Ry(b) Rz(c), b between -pi/2 and pi/2.
/// If b is a right angle, c is 0. Real-time: safe.
inline Eigen::Vector3d euler_angles(const Eigen::Matrix3d& R) noexcept {
  const double sine = std::clamp(R(0, 2), -1.0, 1.0);
  if (std::abs(sine) > 1 - 1e-12)
    return {std::atan2(R(1, 0), R(1, 1)) * (sine > 0 ? 1 : -1), std::asin(sine), 0};
  return {std::atan2(-R(1, 2), R(2, 2)), std::asin(sine), std::atan2(-R(0, 1), R(0, 0))};
}

}  // namespace thimble::compat::dhd
