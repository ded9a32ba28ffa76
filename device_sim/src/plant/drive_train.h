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

/// Amplifiers, motors and cables: lag, saturation, cogging and ripple, heat, stretch and backlash.
/// Its state is currents and temperatures; it has no mechanics. All vectors are joint by joint.
class THIMBLE_EXPORT DriveTrain {
 public:
  /// Makes a drive train without current. Fails if a constant is out of range, if only some cables
  /// stretch, if a cable stretches without motor inertia, or if cogging and ripple have no period.
  /// Real-time: never from the servo thread.
  static driver::Result<DriveTrain> make(const DriveTrainSettings& settings,
                                         const std::array<driver::MotorDrive, 3>& drives,
                                         double current_max);

  /// Sets the requested currents of the amplifiers, A. They saturate; a current that is not a
  /// number counts as zero. Real-time: safe.
  void ask(const Eigen::Vector3d& amperes) noexcept;

  /// Sets the actual currents, A; without lag they always equal the requested ones. Real-time:
  /// safe.
  void put(const Eigen::Vector3d& amperes) noexcept {
    if (settings_.current_lag > 0) amperes_ = amperes;
  }

  /// Advances by dt > 0 (s): the currents approach the requested ones by their exact map, and warm
  /// the motors. Returns their mean over that time, A. Real-time: safe.
  Eigen::Vector3d pass(double dt) noexcept;

  /// Returns the torque of the motors at the joints (N m) at the joint angles of their rotors
  /// (rad). It includes ripple and temperature of the torque constant, and cogging. Real-time:
  /// safe.
  Eigen::Vector3d torque(const Eigen::Vector3d& amperes,
                         const Eigen::Vector3d& q_rotor) const noexcept;

  /// Returns the torque of one cable on its link (N m); the motor feels the opposite. The rotor is
  /// ahead by `turned` (rad) and turns faster by `rate` (rad/s). Zero inside the backlash.
  /// Real-time: safe.
  double pull(int joint, double turned, double rate) const noexcept;

  /// Returns the actual currents, A. Real-time: safe.
  const Eigen::Vector3d& currents() const noexcept { return amperes_; }
  /// Returns the temperature of each winding above the room, K. Real-time: safe.
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
  bool has_ripple_;                    // has cogging or ripple
  Eigen::Vector3d asked_{0, 0, 0};     // A
  Eigen::Vector3d amperes_{0, 0, 0};   // A
};

}  // namespace thimble::device_sim
