#pragma once

#include <Eigen/Core>
#include <array>
#include <complex>
#include <cstddef>
#include <vector>

#include "bringup/identify/weak_form/fitted_motion.h"

namespace thimble::bringup {

/// What waves over the motors' angles do to the equations of a fitted motion: cogging, a torque
/// that is a sine of the motor's angle, and ripple, a torque constant that is. Both are linear in
/// the factors of sine and cosine. The motion must outlive it. Real-time: never from the servo
/// thread.
class WaveRows {
 public:
  /// Columns of each joint: sine and cosine of the cogging, of the ripple.
  static constexpr Eigen::Index kPerJoint = 4, kCount = 12;

  /// Takes a motion with what its fit leaves, and how many turns each motor makes in a turn of its
  /// joint.
  WaveRows(const FittedMotion& motion, const Eigen::Vector3d& ratio);

  /// e^(i angle) of each motor at each tick, the angle being that of so many periods in a turn.
  using Phases = std::vector<std::array<std::complex<double>, 3>>;

  /// Returns the phases for a number of periods in a turn of the motor.
  Phases phases(double periods) const;

  /// Returns the columns for phases, of one equation in `stride`, m/s^2 per factor: the cogging's
  /// in N m at the joint by the arm file's constants, the ripple's relative. `every`: of the ticks
  /// of a bump, one in so many is looked at.
  Eigen::MatrixXd columns(const Phases& phases, std::size_t stride = 1, int every = 1) const;
  Eigen::MatrixXd columns(double periods) const { return columns(phases(periods)); }

  /// Returns how many periods a motor was turned through, but for the last hundredths at both ends.
  Eigen::Vector3d turned(double periods) const { return periods * span_; }

 private:
  const FittedMotion& motion_;
  std::vector<Eigen::Vector3d> angle_;   // of the motors, rad
  std::vector<Eigen::Vector3d> torque_;  // that acts at a tick, N m at the joints by the arm file
  Eigen::Vector3d span_{0, 0, 0};        // turns
};

/// Returns the torques that act at a tick of a motion whose torques come `delay` (s) late: the mean
/// over the tick about it, N m at the joints. Real-time: never from the servo thread.
std::vector<Eigen::Vector3d> acting_torques(const ArmMotion& motion, double delay);

}  // namespace thimble::bringup
