#pragma once

#include <Eigen/Core>

#include "thimble/device_sim/settings.h"
#include "thimble/driver/result.h"

namespace thimble::device_sim {

/// Winding temperatures of three motors, and their effect on torque.
///
/// Each winding is one node, as in the driver's heat guard (thimble/driver/heat_guard.h). But the
/// resistance of its copper grows with temperature, so that the same current heats it more. With
/// the rise T above the room's temperature (K), T_c that of the continuous current I_c, and a the
/// resistance's rise per kelvin,
///
///     tau T' = T_c (I / I_c)^2 (1 + a T) / (1 + a T_c) - T,
///
/// which is linear in T while the current is held. It is advanced by its exact map, once per
/// millisecond, with the mean of the current's square. From (I / I_c)^2 = (1 + a T_c) / (a T_c) on,
/// T has no limit; it is clamped at MotorHeatSettings::kRiseMax. All functions but `make` are
/// Real-time: safe.
class MotorHeat {
 public:
  /// Makes motors with the initial temperatures of the settings. Fails if a constant is out of
  /// range. Real-time: never from the servo thread.
  static driver::Result<MotorHeat> make(const MotorHeatSettings& settings);

  /// Advances by dt > 0 (s) with the currents `amperes`.
  void pass(const Eigen::Vector3d& amperes, double dt) noexcept;

  /// Returns the temperature of each winding above the room, K.
  const Eigen::Vector3d& rise() const noexcept { return rise_; }
  /// Returns the ratios of the torque constants to those at room temperature, 0 or more.
  const Eigen::Vector3d& torque_share() const noexcept { return torque_share_; }

 private:
  explicit MotorHeat(const MotorHeatSettings& settings) noexcept;
  void warm() noexcept;

  MotorHeatSettings settings_;
  Eigen::Vector3d rise_;
  Eigen::Vector3d torque_share_{1, 1, 1};
  Eigen::Vector3d squares_{0, 0, 0};  // of the currents, integrated since the last map, A^2 s
  double time_ = 0;                   // time since the last map, s
};

}  // namespace thimble::device_sim
