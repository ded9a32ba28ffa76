#pragma once

#include <Eigen/Core>
#include <array>

namespace thimble::driver {

/// A rotation as a unit quaternion w, x, y, z in single precision: 6e-8 rad, below the step of any
/// gimbal. All zeros: there is none. The state of a device, its record and a recording hold the
/// same four numbers, so that a replay sees the same orientation to the bit.
using TipQuaternion = std::array<float, 4>;

/// Returns the quaternion of a rotation, w >= 0; all zeros if it is not finite. Real-time: safe.
TipQuaternion quaternion_of(const Eigen::Matrix3d& R) noexcept;

/// Returns the rotation of a quaternion; the identity of one that is all zeros. Real-time: safe.
Eigen::Matrix3d rotation_of(const TipQuaternion& q) noexcept;

}  // namespace thimble::driver
