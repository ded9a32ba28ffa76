#pragma once

#include <Eigen/Core>

namespace thimble::driver {

/// Returns the rotation R_BL of a link in the plane that a yaw turns round z: x along the link, y
/// level. Takes cosine and sine of the yaw, and of the link's angle above the horizontal.
/// Real-time: safe.
inline Eigen::Matrix3d link_rotation(double cos_yaw, double sin_yaw, double cos_climb,
                                     double sin_climb) noexcept {
  Eigen::Matrix3d R_BL;
  // clang-format off
  R_BL << cos_yaw * cos_climb, -sin_yaw, -cos_yaw * sin_climb,
          sin_yaw * cos_climb,  cos_yaw, -sin_yaw * sin_climb,
                    sin_climb,        0,            cos_climb;
  // clang-format on
  return R_BL;
}

}  // namespace thimble::driver
