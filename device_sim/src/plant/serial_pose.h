#pragma once

#include <Eigen/Core>

#include "thimble/driver/serial_arm.h"

namespace thimble::device_sim {

/// The true pose of a serial arm as sines and cosines of its joint angles, found from the tip
/// without trigonometric functions. Frame B: base of the arm.
class SerialPose {
 public:
  /// Lower bound that force_from uses for the sine of the angle between the links, and for the
  /// distance from the yaw axis in units of the first link. Closer to fold, stretch or the yaw axis
  /// the structure carries the force that would be infinite in the formula. [guess: within 3
  /// degrees of the end of travel; no arm is meant to be used there]
  static constexpr double kSingular = 0.05;

  /// Computes the pose whose tip is at p_BT (m), on the branch of SerialArm::inverse and within
  /// reach under the same condition. A tip that is not finite is out of reach. Real-time: safe.
  SerialPose(const driver::SerialArm& arm, const Eigen::Vector3d& p_BT) noexcept;

  /// Returns whether the tip is within reach; if not, no other function may be called. Real-time:
  /// safe.
  bool within_reach() const noexcept { return within_reach_; }

  /// Returns the tip force f_T_B (N) that joint torques tau (N m) exert on a hand: J_BT^-T tau,
  /// bounded near singular poses by kSingular. Real-time: safe.
  Eigen::Vector3d force_from(const Eigen::Vector3d& tau) const noexcept;

  /// Returns the joint angles (A, B, C), rad; equal to SerialArm::inverse. Real-time: safe.
  Eigen::Vector3d angles() const noexcept;

  /// Computes the joint angles within Plant::kAboutError from a nearby pose `from` and its angles
  /// `q_from`, using the sines of the rotations since then, without an arc tangent. Returns false,
  /// and leaves `q` unset, beyond 0.05 rad, near fold or stretch, and near half a turn. Real-time:
  /// safe.
  bool angles_near(const SerialPose& from, const Eigen::Vector3d& q_from,
                   Eigen::Vector3d& q) const noexcept;

 private:
  double length_b_, length_c_;
  double sin_a_ = 0, cos_a_ = 1;
  double sin_b_ = 0, cos_b_ = 1;
  double sin_c_ = 0, cos_c_ = 1;
  double sin_sum_ = 0;  // of B + C, the angle between the links
  double r_ = 0;        // distance of the tip from the yaw axis, m
  bool within_reach_ = false;
};

}  // namespace thimble::device_sim
