#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "thimble/driver/export.h"
#include "thimble/driver/safety_gate.h"

namespace thimble::driver {

/// Describes one motor and the cable that joins it to its joint.
struct MotorDrive {
  double sign = 1;   ///< +1 if a positive current turns the joint to positive angles, else -1.
  double ratio = 1;  ///< Motor turns per joint turn.
  double torque_constant = 0;  ///< Torque per current at the motor, N m/A.
  double current_max = 0;      ///< Largest current the host may ask for, A.

  friend bool operator==(const MotorDrive&, const MotorDrive&) = default;
};

/// Holds motor currents that came through the safety gate. There is no way to make one but from a
/// GatedForce, and no way to send anything else.
class THIMBLE_EXPORT MotorCurrents {
 public:
  /// Zero current in every motor.
  MotorCurrents() = default;

  /// Turns a gated tip force into motor currents by tau = J_BT^T f_T_B. If a motor would need more
  /// than its `current_max`, all three are scaled together so that the force keeps its direction.
  /// A Jacobian that is not finite gives zero. Real-time: safe.
  MotorCurrents(const GatedForce& force, const Eigen::Matrix3d& R_WB, const Eigen::Matrix3d& J_BT,
                const std::array<MotorDrive, 3>& drives) noexcept;

  /// Returns the currents, A.
  const Eigen::Vector3d& amperes() const noexcept { return amperes_; }

  /// Returns what is left of the gated force after the scaling, 0 to 1.
  double scale() const noexcept { return scale_; }

 private:
  Eigen::Vector3d amperes_{0, 0, 0};
  double scale_ = 1;
};

}  // namespace thimble::driver
