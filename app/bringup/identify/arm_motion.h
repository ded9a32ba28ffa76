#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace thimble::bringup {

/// Measured state of an arm at one tick, and the torques sent. Frames: B base, T tip.
struct MotionSample {
  Eigen::Vector3d p_BT{0, 0, 0};  ///< Tip from the encoders, m.
  Eigen::Vector3d q{0, 0, 0};     ///< Joint angles from the encoders, rad.
  /// d q / d p_BT there, rad/m: torques exert the force `G^T tau` on the tip.
  Eigen::Matrix3d G = Eigen::Matrix3d::Zero();
  /// Torques sent and held until the next tick, with the arm file's constants, N m at the joints.
  Eigen::Vector3d tau{0, 0, 0};
  /// Angular accelerations of the motors, with the delay of torques, rad/s^2 at the joints; zero if
  /// unknown.
  Eigen::Vector3d ddq{0, 0, 0};
  bool fresh = false;  ///< The position is from a new report.
};

/// A recorded motion of an arm under known torques, tick by tick.
struct ArmMotion {
  double dt = 0.001;  ///< s between ticks
  /// Number of motors. Those of an arm with fewer than three move the tip along as many axes of the
  /// base; the other joints and axes are at rest and have no torque.
  int motors = 3;
  double added_mass = 0;  ///< Mass that the user fixed to the tip, kg.
  /// Downward direction of the world in the base; the part along axes on which the tip can move.
  Eigen::Vector3d down_B{0, 0, -1};
  Eigen::Vector3d share{1, 1, 1};  ///< Share of the requested torque that was sent, joint by joint.
  Eigen::Vector3d step{0, 0, 0};   ///< Encoder step, rad at the joints.
  /// Known constants of links (LinkEquations) over the mass at the tip, m^2 and m; zero: none. The
  /// forces that links take count as acceleration of the tip.
  Eigen::Matrix<double, 6, 1> links = Eigen::Matrix<double, 6, 1>::Zero();
  std::size_t jumped = 0;  ///< Reports that the driver dropped because of a jump (WireCounters).
  std::vector<MotionSample> samples;  ///< One for each tick.
};

}  // namespace thimble::bringup
