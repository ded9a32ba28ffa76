#pragma once

#include <Eigen/Core>

#include "thimble/device_sim/settings.h"
#include "thimble/driver/result.h"

namespace thimble::device_sim {

/// How warm the windings of three motors are, and what that makes of their torque.
///
/// Each winding is one node, as the driver's heat guard has it (thimble/driver/heat_guard.h), but
/// its copper resists the more the warmer it is, so that the same current heats it more. With the
/// rise T above the room's temperature (K), T_c that of the continuous current I_c, and a the
/// resistance's rise per kelvin,
///
///     tau T' = T_c (I / I_c)^2 (1 + a T) / (1 + a T_c) - T,
///
/// which is linear in T while the current is held: it is followed by its exact map, once in a
/// millisecond, with the mean of the current's square. From (I / I_c)^2 = (1 + a T_c) / (a T_c) on
/// there is no end to it, and it is cut off at
/// MotorHeatSettings::kRiseMost. All functions but `make` are Real-time:
/// safe.
class MotorHeat {
 public:
  /// Makes motors as warm as the settings say. Fails if a constant is out of range. Real-time:
  /// never from the servo thread.
  static driver::Result<MotorHeat> make(const MotorHeatSettings& settings);

  /// Lets dt > 0 (s) pass with the currents `amperes`.
  void pass(const Eigen::Vector3d& amperes, double dt) noexcept;

  /// Returns how much warmer than the room each winding is, K.
  const Eigen::Vector3d& rise() const noexcept { return rise_; }
  /// Returns the torque constants over those at the room's temperature, 0 or more.
  const Eigen::Vector3d& torque_share() const noexcept { return torque_share_; }

 private:
  explicit MotorHeat(const MotorHeatSettings& settings) noexcept;
  void warm() noexcept;

  MotorHeatSettings settings_;
  Eigen::Vector3d rise_;
  Eigen::Vector3d torque_share_{1, 1, 1};
  Eigen::Vector3d squares_{0, 0, 0};  // of the currents, integrated since the last map, A^2 s
  double time_ = 0;                   // since then, s
};

}  // namespace thimble::device_sim
