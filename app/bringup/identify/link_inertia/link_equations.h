#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "bringup/identify/arm_motion.h"
#include "bringup/identify/smooth_bump.h"
#include "bringup/identify/weak_form/motion_equations.h"
#include "thimble/driver/serial_arm.h"

namespace thimble::bringup {

/// Factors of the constants of a serial arm's links in the weak form. The equations of motion are
/// those of device_sim::LinkSettings, which names their sources, mapped to the tip by G^T. Motion
/// does not distinguish a mass m at the tip from the sum of three parts. These are inertia B and
/// yaw_b of m length_b^2, inertia C and yaw_c of m length_c^2, and coupling of m length_b length_c.
/// It also does not distinguish a weight at the tip from moments along both links. So coupling and
/// moment_c have no columns: they are part of the tip. The motion must outlive it. Real-time: never
/// from the servo thread.
class LinkEquations {
 public:
  /// Index of each constant in a row: inertia A, B, C, yaw_b and yaw_c (kg m^2), moment_b (kg m).
  enum Index { kInertia = 0, kYawB = 3, kYawC = 4, kMomentB = 5, kCount = 6 };
  using Row = Eigen::Matrix<double, kCount, 1>;

  explicit LinkEquations(const ArmMotion& motion);

  /// Returns the force (N) along an equation's axis that moves the links, per constant. Gravity's
  /// is the force that must be added to hold against it.
  Row row(const MotionEquations::Equation& equation) const;

  /// Effect of the encoders' steps on mass at the tip (first) and on the five inertias in one
  /// equation. It is the covariance of these columns if the steps were uniform noise, (m/s^2)^2 and
  /// corresponding units.
  using StepNoise = Eigen::Matrix<double, 6, 6>;
  StepNoise step_noise(const MotionEquations::Equation& equation) const;

 private:
  static constexpr int kHalf = MotionEquations::kHalf;
  using Inertias = Eigen::Matrix<double, 5, 1>;

  const MotionSample& at(int tick) const { return motion_.samples[static_cast<std::size_t>(tick)]; }
  /// Force along each axis for the acceleration of each inertia's joint (rad/s^2), N.
  using Levers = Eigen::Matrix<double, 5, 3>;
  static Levers levers_of(const MotionSample& sample);
  /// Returns the centrifugal and Coriolis forces along an axis, N.
  Inertias turning(int tick, int axis) const;

  driver::SerialArm moment_;  // its Jacobian is that of a moment of 1 along link B
  const ArmMotion& motion_;
  SmoothBump<kHalf> bump_;
  double area_ = 0;
  double curvature_ = 0;                 // sum of the squares of the bump's curvature, 1/s^4
  std::vector<Levers> levers_;           // per tick
  std::vector<Eigen::Vector3d> pulled_;  // force of gravity on that moment, along the axes, N
  std::vector<Eigen::Vector3d> rate_;    // smoothed q', rad/s
};

/// Returns the inertia of the links at the tip for a sample, G^T M(q) G, with the constants in the
/// order of a row, kg. Real-time: never from the servo thread.
Eigen::Matrix3d links_at_tip(const LinkEquations::Row& links, const MotionSample& sample);

}  // namespace thimble::bringup
