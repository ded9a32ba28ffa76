#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "thimble/driver/export.h"

namespace thimble::driver {

/// Rotation as a unit quaternion w, x, y, z. All zeros: no orientation. Its single precision
/// resolves 6e-8 rad, less than the encoder step of any gimbal. Device states, tick records and
/// recordings contain the same four numbers. The orientation in a replay is therefore
/// bit-identical.
using TipQuaternion = std::array<float, 4>;

/// Returns the quaternion of a rotation, with w >= 0; all zeros if the rotation is not finite.
/// Real-time: safe.
THIMBLE_EXPORT TipQuaternion quaternion_of(const Eigen::Matrix3d& R) noexcept;

/// Returns the rotation of a quaternion; the identity if it is all zeros. Real-time: safe.
THIMBLE_EXPORT Eigen::Matrix3d rotation_of(const TipQuaternion& q) noexcept;

/// Axis of a frame.
enum class FrameAxis : std::uint8_t {
  kX,  ///< x
  kY,  ///< y
  kZ,  ///< z
};

/// Returns the rotation about an axis by an angle (rad), counterclockwise as seen from the positive
/// end of the axis (right-hand rule). Real-time: safe.
THIMBLE_EXPORT Eigen::Matrix3d rotation_about(FrameAxis axis, double angle) noexcept;

/// Gimbal between the last link of an arm and the stylus in the hand. It has three axes in series,
/// each with an encoder and no motor. The data is constant for one arm model.
///
///     R_BT = R_BL R(axis 1, angle 1) R(axis 2, angle 2) R(axis 3, angle 3)
///
/// Frames: B is the base of the arm. L is the last link, as returned by `last_link` of each
/// geometry. T is the stylus; its axes are those of L when all angles are zero. All functions are
/// Real-time: safe.
struct THIMBLE_EXPORT Gimbal {
  /// Rotation axes in the order from link to stylus, each in the frame after the previous
  /// rotations.
  std::array<FrameAxis, 3> axes{FrameAxis::kX, FrameAxis::kY, FrameAxis::kX};
  std::array<double, 3> sign{1, 1, 1};        ///< +1 if counts grow with the angle, else -1.
  std::array<double, 3> counts_per_turn{};    ///< Counts per turn of each encoder.
  std::array<std::int32_t, 3> home_counts{};  ///< Counts at the home pose; added to each counter.

  friend bool operator==(const Gimbal&, const Gimbal&) = default;

  /// Returns the angles (rad) for these counter values.
  Eigen::Vector3d angles(const std::array<std::int32_t, 3>& counters) const noexcept;

  /// Returns the unrounded counter values at these angles (rad). This is the inverse of `angles`.
  Eigen::Vector3d exact_counts(const Eigen::Vector3d& angles) const noexcept;

  /// Returns the rotation R_LT of the stylus in the frame of the last link.
  Eigen::Matrix3d rotation(const Eigen::Vector3d& angles) const noexcept;
};

}  // namespace thimble::driver
