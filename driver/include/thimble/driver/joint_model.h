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

/// Describes one encoder and where its zero lies.
struct JointEncoder {
  double sign = 1;                   ///< +1 if counts grow with the joint angle, else -1.
  double counts_per_motor_turn = 0;  ///< Quadrature counts per turn of the motor.
  std::int64_t home_counts = 0;      ///< Added to the counter, which is zero at the home pose.
};

/// Joins a geometry to its motors and encoders: data of one model of an arm, no state. A geometry
/// has `void forward(q, p_BT, J_BT) const noexcept` and `Matrix3d last_link(q, p_BT) const
/// noexcept` (SerialArm, LinkageArm, DeltaArm). All functions are Real-time: safe.
template <class Geometry>
struct JointModel {
  Geometry geometry;                     ///< Links and home pose.
  std::array<MotorDrive, 3> drives;      ///< Motors.
  std::array<JointEncoder, 3> encoders;  ///< Encoders.
  std::optional<Gimbal> gimbal{};        ///< Behind the last link, if one is mounted.

  /// Returns the joint angle of one encoder step, rad.
  double step(std::size_t joint) const noexcept {
    return 2 * std::numbers::pi / (encoders[joint].counts_per_motor_turn * drives[joint].ratio);
  }

  /// Turns the counter values of a reading into joint angles, rad.
  Eigen::Vector3d joint_angles(const ArmReading& reading) const noexcept {
    Eigen::Vector3d q;
    for (std::size_t i = 0; i < 3; ++i) {
      // As doubles: a counter of 32 bits and its home may overflow an integer.
      const double counts =
          static_cast<double>(reading.counts[i]) + static_cast<double>(encoders[i].home_counts);
      q[static_cast<Eigen::Index>(i)] = encoders[i].sign * counts * step(i);
    }
    return q;
  }

  /// The inverse of `joint_angles` before rounding: counter values at joint angles q (rad).
  Eigen::Vector3d exact_counts(const Eigen::Vector3d& q) const noexcept {
    Eigen::Vector3d counts;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      counts[k] = encoders[i].sign * q[k] / step(i) - static_cast<double>(encoders[i].home_counts);
    }
    return counts;
  }
};

/// Returns the same arm with encoders of `times` as many steps: what ideal encoders are made of.
/// A power of two leaves every angle as it is to the bit. Real-time: safe.
template <class Geometry>
JointModel<Geometry> with_fine_counts(JointModel<Geometry> model, int times = 65536) noexcept {
  for (JointEncoder& encoder : model.encoders) {
    encoder.counts_per_motor_turn *= times;
    encoder.home_counts *= times;
  }
  return model;
}

}  // namespace thimble::driver
