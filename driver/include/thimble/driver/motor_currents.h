#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "thimble/driver/export.h"
#include "thimble/driver/safety_gate.h"

namespace thimble::driver {

/// One motor and the cable that connects it to its joint.
struct MotorDrive {
  /// +1 if a positive current turns the joint to positive angles, -1 if to negative ones, 0: the
  /// arm has no such motor.
  double sign = 1;
  double ratio = 1;            ///< Motor turns per joint turn.
  double torque_constant = 0;  ///< Torque per current at the motor, N m/A.
  double current_max = 0;      ///< Largest current that the host may request, A.

  friend bool operator==(const MotorDrive&, const MotorDrive&) = default;
};

/// Motor currents that have passed the safety gate. They can be created only from a GatedForce, and
/// nothing else can be sent.
class THIMBLE_EXPORT MotorCurrents {
 public:
  /// Constructs zero current in every motor.
  MotorCurrents() = default;

  /// Converts a gated tip force into motor currents by tau = J_BT^T f_T_B. If a motor would need
  /// more than its `current_max`, all three are scaled together so that the force keeps its
  /// direction. A Jacobian that is not finite gives zero. Real-time: safe.
  MotorCurrents(const GatedForce& force, const Eigen::Matrix3d& R_WB, const Eigen::Matrix3d& J_BT,
                const std::array<MotorDrive, 3>& drives) noexcept;

  /// Returns the currents, A.
  const Eigen::Vector3d& amperes() const noexcept { return amperes_; }

  /// Returns the fraction of the gated force that remains after scaling, 0 to 1.
  double scale() const noexcept { return scale_; }

 private:
  Eigen::Vector3d amperes_{0, 0, 0};
  double scale_ = 1;
};

}  // namespace thimble::driver
