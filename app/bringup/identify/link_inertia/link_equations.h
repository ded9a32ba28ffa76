#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "bringup/identify/arm_motion.h"
#include "bringup/identify/smooth_bump.h"
#include "bringup/identify/weak_form/motion_equations.h"
#include "thimble/driver/serial_arm.h"

namespace thimble::bringup {

/// What the constants of a serial arm's links multiply, in the weak form: the equations of motion
/// of device_sim::LinkSettings, whose sources it names, drawn to the tip by G^T. Motion cannot tell
/// a mass m at the tip from inertia B and yaw_b of m length_b^2, inertia C and yaw_c of m
/// length_c^2 and coupling of m length_b length_c, nor a weight at the tip from moments along both
/// links. So coupling and moment_c are none of the columns: the tip has them. The motion must
/// outlive it. Real-time: never from the servo thread.
class LinkEquations {
 public:
  /// Index of each constant in a row: inertia A, B, C, yaw_b and yaw_c (kg m^2), moment_b (kg m).
  enum Index { kInertia = 0, kYawB = 3, kYawC = 4, kMomentB = 5, kCount = 6 };
  using Row = Eigen::Matrix<double, kCount, 1>;

  explicit LinkEquations(const ArmMotion& motion);

  /// Returns the force (N) along an equation's axis that moves the links, for each constant.
  /// Gravity's has the sign of what must be added to hold against it.
  Row row(const MotionEquations::Equation& equation) const;

  /// What the steps of the encoders make of mass at the tip (first) and of the five inertias in one
  /// equation: the covariance of these columns, were the steps evenly spread noise, (m/s^2)^2 and
  /// what goes with it.
  using StepNoise = Eigen::Matrix<double, 6, 6>;
  StepNoise step_noise(const MotionEquations::Equation& equation) const;

 private:
  static constexpr int kHalf = MotionEquations::kHalf;
  using Inertias = Eigen::Matrix<double, 5, 1>;

  const MotionSample& at(int tick) const { return motion_.samples[static_cast<std::size_t>(tick)]; }
  /// What an acceleration of each inertia's one joint (rad/s^2) takes along each axis, N.
  using Levers = Eigen::Matrix<double, 5, 3>;
  static Levers levers_of(const MotionSample& sample);
  /// Returns what turning at a rate takes along an axis: centrifugal and Coriolis forces, N.
  Inertias turning(int tick, int axis) const;

  driver::SerialArm moment_;  // whose Jacobian is that of a moment of 1 along link B
  const ArmMotion& motion_;
  SmoothBump<kHalf> bump_;
  double area_ = 0;
  double curvature_ = 0;                 // of the bump, the sum of its squares, 1/s^4
  std::vector<Levers> levers_;           // tick by tick
  std::vector<Eigen::Vector3d> pulled_;  // by gravity on that moment, along the axes, N
  std::vector<Eigen::Vector3d> rate_;    // smoothed q', rad/s
};

/// Returns what links are to the tip at a sample, G^T M(q) G, by constants as they stand in a row,
/// kg. Real-time: never from the servo thread.
Eigen::Matrix3d links_at_tip(const LinkEquations::Row& links, const MotionSample& sample);

}  // namespace thimble::bringup
