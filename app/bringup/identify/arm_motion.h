#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace thimble::bringup {

/// What was seen of an arm at one tick, and what its motors were asked for. Frames: B base, T tip.
struct MotionSample {
  Eigen::Vector3d p_BT{0, 0, 0};  ///< Where the encoders say the tip is, m.
  Eigen::Vector3d q{0, 0, 0};     ///< What the encoders say of the joints, rad.
  /// d q / d p_BT there, rad/m: torques pull on the tip by `G^T tau`.
  Eigen::Matrix3d G = Eigen::Matrix3d::Zero();
  /// Torques that were sent and stand until the next tick, by the arm file's constants, N m at the
  /// joints.
  Eigen::Vector3d tau{0, 0, 0};
  /// Angular accelerations of the motors, as late as torques are, rad/s^2 at the joints; zero where
  /// they are not known.
  Eigen::Vector3d ddq{0, 0, 0};
  bool fresh = false;  ///< A new report told the position.
};

/// A stretch of an arm's motion under known torques, tick by tick.
struct ArmMotion {
  double dt = 0.001;                 ///< s between ticks
  double added_mass = 0;             ///< That the user fixed to the tip, kg.
  Eigen::Vector3d down_B{0, 0, -1};  ///< Where the world's down is in the base.
  Eigen::Vector3d share{1, 1, 1};    ///< Of the torque that was asked for, joint by joint.
  Eigen::Vector3d step{0, 0, 0};     ///< Of the encoders, rad at the joints.
  /// Constants of links that are known (LinkEquations) over the mass at the tip, m^2 and m; zero:
  /// none are. What they take counts as acceleration of the tip.
  Eigen::Matrix<double, 6, 1> links = Eigen::Matrix<double, 6, 1>::Zero();
  std::size_t jumped = 0;  ///< Reports that the driver dropped for a jump (WireCounters).
  std::vector<MotionSample> samples;  ///< One for each tick.
};

}  // namespace thimble::bringup
