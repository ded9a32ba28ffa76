#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "thimble/device_sim/axis_dynamics.h"
#include "thimble/device_sim/settings.h"
#include "thimble/driver/delta_arm.h"
#include "thimble/driver/joint_model.h"

namespace thimble::device_sim {

/// Is the mechanics of a delta arm with a hand on it: as ArmPlant, with three legs instead of
/// links. Its force comes from the inverse kinematics alone: by virtual work f = (dq/dp)^T tau,
/// and dq/dp is a central difference over 1 um (error about 1e-9 of itself). So it shares nothing
/// with the Jacobian by which a driver turns forces into torques. Frames: B base of the arm, T tip,
/// H where the hand wants to be.
class DeltaPlant {
 public:
  /// Rests the arm at p_BT (m), with the hand wanting to be there. Throws std::invalid_argument if
  /// a constant is out of range or p_BT out of reach. Real-time: never from the servo thread.
  DeltaPlant(const driver::JointModel<driver::DeltaArm>& model, const PlantSettings& plant,
             const HandSettings& hand, const MotorSettings& motors, const Eigen::Vector3d& p_BT);

  /// Sets what the amplifiers are asked for, A; they saturate; what is not a number counts as zero.
  /// Real-time: safe.
  void set_currents(const Eigen::Vector3d& amperes) noexcept;

  /// Lets 0 < dt_ns <= 1 ms pass, while the point the hand wants moves evenly to p_BH (m). At the
  /// end of reach the tip stays where it was, with no velocity. Real-time: safe.
  void step(const Eigen::Vector3d& p_BH, std::int64_t dt_ns) noexcept;

  /// Tells where the tip is, m. Real-time: safe.
  Eigen::Vector3d p_BT() const noexcept { return {axes_[0].x, axes_[1].x, axes_[2].x}; }
  /// Tells the true leg angles, rad. Real-time: safe.
  const Eigen::Vector3d& q() const noexcept { return q_; }
  /// Tells the true encoder counts before rounding. Real-time: safe.
  Eigen::Vector3d exact_counts() const noexcept { return model_.exact_counts(q_); }
  /// Tells the currents that flow, A. Real-time: safe.
  const Eigen::Vector3d& currents() const noexcept { return amperes_; }
  /// Finds the force that the motors make on a hand at the tip's place now, N. Real-time: safe.
  Eigen::Vector3d f_T_B() const noexcept;

 private:
  driver::JointModel<driver::DeltaArm> model_;
  Eigen::Vector3d torque_per_ampere_;  // at the legs, N m/A
  double current_max_;                 // A
  AxisDynamics dynamics_;
  std::array<AxisState, 3> axes_;
  Eigen::Vector3d p_BH_;
  Eigen::Vector3d q_;
  Eigen::Vector3d amperes_{0, 0, 0};
};

}  // namespace thimble::device_sim
