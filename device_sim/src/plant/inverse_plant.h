#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "plant/axis_dynamics.h"
#include "plant/board_geometry.h"
#include "plant/plant.h"
#include "thimble/device_sim/settings.h"
#include "thimble/driver/delta_arm.h"
#include "thimble/driver/export.h"
#include "thimble/driver/joint_model.h"
#include "thimble/driver/linkage_arm.h"
#include "thimble/driver/result.h"

namespace thimble::device_sim {

/// The mechanics of an arm whose inverse kinematics are known (`inverse(p_BT)`), with a hand on it:
/// like ArmPlant, for any geometry. Its force uses only the inverse kinematics: by virtual work f =
/// (dq/dp)^T tau, and dq/dp is a central difference over 1 um (relative error about 1e-9). So it is
/// independent of the Jacobian with which a driver turns forces into torques. Defined for DeltaArm,
/// LinkageArm and BoardGeometry. The tip of an arm with one or two motors stays on its line or
/// plane if no force and no hand leaves it, which SimulatedArm ensures. All functions but the
/// constructor are Real-time: safe.
template <class Geometry>
class THIMBLE_EXPORT InversePlant final : public Plant {
 public:
  /// Makes the arm at rest at p_BT (m). The hand wants to be at p_BH (m). Fails if a constant is
  /// out of range or p_BT out of reach. Real-time: never from the servo thread.
  static driver::Result<InversePlant> make(const driver::JointModel<Geometry>& model,
                                           const PlantSettings& plant, const HandSettings& hand,
                                           const MotorSettings& motors, const Eigen::Vector3d& p_BT,
                                           const Eigen::Vector3d& p_BH);

  void set_currents(const Eigen::Vector3d& amperes) noexcept override;
  void step(const Eigen::Vector3d& p_BH, std::int64_t dt_ns) noexcept override;
  void take_tip(const AxisDynamics& tip) noexcept override { dynamics_ = tip; }
  void set_pull(const Eigen::Vector3d& f_T_B) noexcept override { pull_B_ = f_T_B; }
  Eigen::Vector3d p_BT() const noexcept override { return {axes_[0].x, axes_[1].x, axes_[2].x}; }
  Eigen::Vector3d v_BT() const noexcept override { return {axes_[0].v, axes_[1].v, axes_[2].v}; }
  const Eigen::Vector3d& p_BH() const noexcept override { return p_BH_; }
  Eigen::Vector3d q() const noexcept override { return q_; }
  const Eigen::Vector3d& currents() const noexcept override { return amperes_; }
  Eigen::Vector3d f_T_B() const noexcept override;
  std::uint64_t stops() const noexcept override { return stops_; }

  /// Returns the true encoder counts before rounding.
  Eigen::Vector3d exact_counts() const noexcept { return model_.exact_counts(q_); }

 private:
  InversePlant(const driver::JointModel<Geometry>& model, const AxisDynamics& dynamics,
               double current_max, const Eigen::Vector3d& p_BT, const Eigen::Vector3d& p_BH,
               const Eigen::Vector3d& q) noexcept;

  driver::JointModel<Geometry> model_;
  Eigen::Vector3d torque_per_ampere_;  // at the joints, N m/A
  double current_max_;                 // A
  AxisDynamics dynamics_;
  std::array<AxisState, 3> axes_;
  Eigen::Vector3d p_BH_;
  Eigen::Vector3d q_;
  Eigen::Vector3d amperes_{0, 0, 0};
  Eigen::Vector3d pull_B_{0, 0, 0};  // N
  std::uint64_t stops_ = 0;
};

using DeltaPlant = InversePlant<driver::DeltaArm>;
using LinkagePlant = InversePlant<driver::LinkageArm>;
using BoardPlant = InversePlant<BoardGeometry>;

}  // namespace thimble::device_sim
