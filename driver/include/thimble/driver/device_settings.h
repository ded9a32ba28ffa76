#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "thimble/driver/heat_guard.h"
#include "thimble/driver/motion_watch.h"
#include "thimble/driver/result.h"
#include "thimble/driver/safety_gate.h"

namespace thimble::driver {

/// Sets how a device is placed and what it tolerates.
struct DeviceSettings {
  Eigen::Matrix3d R_WB = Eigen::Matrix3d::Identity();  ///< Rotation of the arm's base in the world.
  Eigen::Vector3d p_WB{0, 0, 0};                       ///< Position of the arm's base, m.
  GateLimits limits;                                   ///< Of force, rise and speed.
  EnergyGuardSettings energy{};                ///< Which energy stage the gate has; none: free.
  MotionWatchSettings motion{};                ///< What motors and encoders are watched by.
  HeatSettings heat{};                         ///< Of the motors; none: not known.
  double velocity_corner_frequency = 0;        ///< Pole of the velocity estimate, Hz; 0: none.
  std::int64_t silence_limit_ns = 20'000'000;  ///< Silence of the arm that is a fault, ns (20
                                               ///< reports of a full-speed USB arm; chosen).

  /// Fails if a limit is not a positive finite number or protects nobody (GateLimits). Real-time:
  /// never from the servo thread.
  Result<void> check() const;
};

}  // namespace thimble::driver
