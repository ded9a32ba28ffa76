#pragma once

#include <Eigen/Core>
#include <array>
#include <complex>
#include <cstddef>
#include <vector>

#include "bringup/identify/weak_form/fitted_motion.h"

namespace thimble::bringup {

/// Effect of waves over the motors' angles on the equations of a fitted motion. Cogging is a torque
/// that is a sine of the motor's angle; ripple is such a sine in the torque constant. Both are
/// linear in the factors of sine and cosine. The motion must outlive it. Real-time: never from the
/// servo thread.
class CoggingRows {
 public:
  /// Columns of each joint: sine and cosine of the cogging, of the ripple.
  static constexpr Eigen::Index kPerJoint = 4, kCount = 12;

  /// Takes a motion with the residual of its fit, and the motor turns per joint turn.
  CoggingRows(const FittedMotion& motion, const Eigen::Vector3d& ratio);

  /// e^(i angle) of each motor at each tick, for an angle with a given number of periods per turn.
  using Phases = std::vector<std::array<std::complex<double>, 3>>;

  /// Returns the phases for a number of periods per turn of the motor.
  Phases phases(double periods) const;

  /// Returns the columns for phases, of one equation in `stride`, m/s^2 per factor: cogging in N m
  /// at the joint with the arm file's constants, ripple relative. `every`: uses one in this many
  /// ticks of a bump.
  Eigen::MatrixXd columns(const Phases& phases, std::size_t stride = 1, int every = 1) const;
  Eigen::MatrixXd columns(double periods) const { return columns(phases(periods)); }

  /// Returns the number of periods through which each motor turned, without the outermost
  /// hundredths.
  Eigen::Vector3d turned(double periods) const { return periods * span_; }

 private:
  const FittedMotion& motion_;
  std::vector<Eigen::Vector3d> angle_;   // of the motors, rad
  std::vector<Eigen::Vector3d> torque_;  // acting at a tick, N m at the joints by the arm file
  Eigen::Vector3d span_{0, 0, 0};        // turns
};

/// Returns the torques that act at a tick of a motion whose torques are `delay` (s) late. It is the
/// mean over the tick about it, N m at the joints. Real-time: never from the servo thread.
std::vector<Eigen::Vector3d> acting_torques(const ArmMotion& motion, double delay);

}  // namespace thimble::bringup
