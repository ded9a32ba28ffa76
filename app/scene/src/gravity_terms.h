#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <cmath>

#include "thimble/driver/serial_arm.h"
#include "thimble/scene/arm_file.h"

namespace thimble::scene {

/// Standard gravity, m/s^2 [CGPM 1901].
inline constexpr double kGravity = 9.80665;

/// Force at the tip that compensates the weight of a serial arm's links in each pose, from their
/// first moments of mass (ArmFile::carried_moments). Frames: W world, B base.
struct LinkGravity {
  driver::SerialArm arm;      ///< Geometry of the arm.
  driver::SerialArm moments;  ///< Moments along B and C instead of lengths, kg m.
  Eigen::Matrix3d R_WB = Eigen::Matrix3d::Identity();
  double max_force = 0;  ///< Largest compensation force, N.

  /// Returns the force at joint angles q (rad), N in the world; zero if the Jacobian is singular.
  /// Real-time: safe.
  Eigen::Vector3d carried(const Eigen::Vector3d& q) const noexcept {
    const Eigen::Vector3d up_B = R_WB.transpose() * Eigen::Vector3d(0, 0, kGravity);
    // The moments act on the links as a weight at the tip acts on both lengths.
    const Eigen::Vector3d tau = moments.jacobian(q).transpose() * up_B;
    const Eigen::Vector3d f_W = R_WB * (arm.jacobian(q).transpose().inverse() * tau);
    const double length = f_W.norm();
    if (length <= max_force) return f_W;
    if (!(length < HUGE_VAL)) return {0, 0, 0};
    return f_W * (max_force / length);
  }

  /// Returns the potential of that force at joint angles q, J: minus the height of the moments
  /// times gravity. Real-time: safe.
  double potential(const Eigen::Vector3d& q) const noexcept {
    const Eigen::Vector3d up_B = R_WB.transpose() * Eigen::Vector3d(0, 0, kGravity);
    return -up_B.dot(moments.forward(q));
  }
};

/// Returns the compensation of an arm file. Precondition: it is a serial arm. Real-time: never from
/// the servo thread.
inline LinkGravity link_gravity(const ArmFile& file) {
  return {.arm = std::get<driver::SerialArm>(file.model.geometry),
          .moments = {.height = 0,
                      .length_b = file.carried_moments[0],
                      .length_c = file.carried_moments[1]},
          .R_WB = file.R_WB,
          .max_force = file.limits.force_max / 3 - file.carried_weight};
}

}  // namespace thimble::scene
