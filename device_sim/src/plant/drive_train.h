#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "plant/motor_heat.h"
#include "thimble/device_sim/settings.h"
#include "thimble/driver/export.h"
#include "thimble/driver/motor_currents.h"
#include "thimble/driver/result.h"

namespace thimble::device_sim {

/// What amplifiers, motors and cables make of currents: lag, saturation, cogging and ripple, heat,
/// stretch and play. It holds currents and temperatures and no mechanics. All vectors go joint by
/// joint.
class THIMBLE_EXPORT DriveTrain {
 public:
  /// Makes one without current. Fails if a constant is out of range, if only some cables stretch,
  /// if a cable stretches without an inertia before it, or if cogging and ripple have no period.
  /// Real-time: never from the servo thread.
  static driver::Result<DriveTrain> make(const DriveTrainSettings& settings,
                                         const std::array<driver::MotorDrive, 3>& drives,
                                         double current_max);

  /// Sets what the amplifiers are asked for, A. They saturate; what is not a number counts as zero.
  /// Real-time: safe.
  void ask(const Eigen::Vector3d& amperes) noexcept;

  /// Lets other currents flow, A; without lag what is asked for flows. Real-time: safe.
  void put(const Eigen::Vector3d& amperes) noexcept {
    if (settings_.current_lag > 0) amperes_ = amperes;
  }

  /// Lets dt > 0 (s) pass: the currents approach what is asked for by their exact map, and warm the
  /// motors. Returns their mean over that time, A. Real-time: safe.
  Eigen::Vector3d pass(double dt) noexcept;

  /// Returns the torque of the motors at the joints (N m) at the joint angles of their rotors
  /// (rad): torque constant with its ripple and as warm as it is, and the cogging. Real-time: safe.
  Eigen::Vector3d torque(const Eigen::Vector3d& amperes,
                         const Eigen::Vector3d& q_rotor) const noexcept;

  /// Returns what one cable pulls its link with (N m), which its motor feels against it, when the
  /// rotor is ahead by `turned` (rad) and turns faster by `rate` (rad/s). In its play it pulls not
  /// at all. Real-time: safe.
  double pull(int joint, double turned, double rate) const noexcept;

  /// Returns the currents that flow, A. Real-time: safe.
  const Eigen::Vector3d& currents() const noexcept { return amperes_; }
  /// Returns how much warmer than the room each winding is, K. Real-time: safe.
  Eigen::Vector3d winding_rise() const noexcept {
    return heat_ ? heat_->rise() : Eigen::Vector3d(0, 0, 0);
  }
  const DriveTrainSettings& settings() const noexcept { return settings_; }

 private:
  DriveTrain(const DriveTrainSettings& settings, const std::array<driver::MotorDrive, 3>& drives,
             double current_max, const std::optional<MotorHeat>& heat) noexcept;
  Eigen::Vector3d mean_current(double dt) noexcept;

  DriveTrainSettings settings_;
  std::optional<MotorHeat> heat_;
  Eigen::Vector3d torque_per_ampere_;  // at the joints, N m/A
  Eigen::Vector3d ratio_;              // motor turns per joint turn
  double current_max_;                 // A
  bool wavy_;                          // it has cogging or ripple
  Eigen::Vector3d asked_{0, 0, 0};     // A
  Eigen::Vector3d amperes_{0, 0, 0};   // A
};

}  // namespace thimble::device_sim
