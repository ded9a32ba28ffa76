#pragma once

#include <Eigen/Core>
#include <array>

#include "thimble/device_sim/settings.h"
#include "thimble/driver/motor_currents.h"
#include "thimble/driver/result.h"

namespace thimble::device_sim {

/// What amplifiers, motors and cables make of currents: lag, saturation, cogging and ripple,
/// stretch and play. It holds the currents and no mechanics. All vectors go joint by joint.
class DriveTrain {
 public:
  /// Makes one without current. Fails if a constant is out of range, if only some cables stretch,
  /// if a cable stretches or rubs without an inertia before it, or if cogging and ripple have no
  /// period. Real-time: never from the servo thread.
  static driver::Result<DriveTrain> make(const DriveTrainSettings& settings,
                                         const std::array<driver::MotorDrive, 3>& drives,
                                         double current_max);

  /// Sets what the amplifiers are asked for, A. They saturate; what is not a number counts as zero.
  /// Real-time: safe.
  void ask(const Eigen::Vector3d& amperes) noexcept;

  void put(const Eigen::Vector3d& amperes) noexcept {
    if (settings_.current_lag > 0) amperes_ = amperes;
  }
  /// Lets dt > 0 (s) pass: the currents approach what is asked for by their exact map. Returns
  /// their mean over that time, A. Real-time: safe.
  Eigen::Vector3d pass(double dt) noexcept;

  /// Returns the torque of the motors at the joints (N m) at the joint angles of their rotors
  /// (rad): torque constant with its ripple, and the cogging. Real-time: safe.
  Eigen::Vector3d torque(const Eigen::Vector3d& amperes,
                         const Eigen::Vector3d& q_rotor) const noexcept;

  /// Returns what one cable pulls its link with (N m), which its motor feels against it, when the
  /// rotor is ahead by `turned` (rad) and turns faster by `rate` (rad/s). In its play it pulls not
  /// at all. Real-time: safe.
  double pull(int joint, double turned, double rate) const noexcept;

  /// Returns the currents that flow, A. Real-time: safe.
  const Eigen::Vector3d& currents() const noexcept { return amperes_; }
  const DriveTrainSettings& settings() const noexcept { return settings_; }

 private:
  DriveTrain(const DriveTrainSettings& settings, const std::array<driver::MotorDrive, 3>& drives,
             double current_max) noexcept;

  DriveTrainSettings settings_;
  Eigen::Vector3d torque_per_ampere_;  // at the joints, N m/A
  Eigen::Vector3d ratio_;              // motor turns per joint turn
  double current_max_;                 // A
  bool wavy_;                          // it has cogging or ripple
  Eigen::Vector3d asked_{0, 0, 0};     // A
  Eigen::Vector3d amperes_{0, 0, 0};   // A
};

}  // namespace thimble::device_sim
