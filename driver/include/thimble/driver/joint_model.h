#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <numbers>
#include <optional>

#include "thimble/driver/arm.h"
#include "thimble/driver/motor_currents.h"
#include "thimble/driver/orientation.h"

namespace thimble::driver {

/// Encoder of one joint and its zero.
struct JointEncoder {
  double sign = 1;  ///< +1 if counts grow with the joint angle, -1 if they fall, 0: no encoder.
  double counts_per_motor_turn = 0;  ///< Quadrature counts per turn of the motor.
  /// Counts at the home pose, where the counter is zero; added to the counter.
  std::int64_t home_counts = 0;
};

/// A geometry with its motors and encoders: the stateless data of one arm model. A geometry has
/// `void forward(q, p_BT, J_BT) const noexcept` and `Matrix3d last_link(q, p_BT) const noexcept`
/// (SerialArm, LinkageArm, DeltaArm). All functions are Real-time: safe.
template <class Geometry>
struct JointModel {
  Geometry geometry;                     ///< Links and home pose.
  std::array<MotorDrive, 3> drives;      ///< Motors.
  std::array<JointEncoder, 3> encoders;  ///< Encoders.
  std::optional<Gimbal> gimbal{};        ///< Gimbal behind the last link, if mounted.

  /// Returns the change of a joint angle per encoder count, rad.
  double step(std::size_t joint) const noexcept {
    return 2 * std::numbers::pi / (encoders[joint].counts_per_motor_turn * drives[joint].ratio);
  }

  /// Returns the joint angles for the counter values of a reading, rad.
  Eigen::Vector3d joint_angles(const ArmReading& reading) const noexcept {
    Eigen::Vector3d q;
    for (std::size_t i = 0; i < 3; ++i) {
      // Computed as doubles, because a counter of 32 bits plus its home can overflow an integer.
      const double counts =
          static_cast<double>(reading.counts[i]) + static_cast<double>(encoders[i].home_counts);
      q[static_cast<Eigen::Index>(i)] = encoders[i].sign * counts * step(i);
    }
    return q;
  }

  /// Returns the counter values at joint angles q (rad) before rounding: the inverse of
  /// `joint_angles`.
  Eigen::Vector3d exact_counts(const Eigen::Vector3d& q) const noexcept {
    Eigen::Vector3d counts;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      counts[k] = encoders[i].sign * q[k] / step(i) - static_cast<double>(encoders[i].home_counts);
    }
    return counts;
  }
};

/// Returns the same arm with encoders of `times` the resolution, to approximate ideal encoders. If
/// `times` is a power of two, every angle stays bit-identical. Real-time: safe.
template <class Geometry>
JointModel<Geometry> with_fine_counts(JointModel<Geometry> model, int times = 65536) noexcept {
  for (JointEncoder& encoder : model.encoders) {
    encoder.counts_per_motor_turn *= times;
    encoder.home_counts *= times;
  }
  return model;
}

}  // namespace thimble::driver
