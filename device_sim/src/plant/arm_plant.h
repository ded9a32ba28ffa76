#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "plant/axis_dynamics.h"
#include "plant/plant.h"
#include "plant/serial_pose.h"
#include "thimble/device_sim/settings.h"
#include "thimble/driver/export.h"
#include "thimble/driver/motor_currents.h"
#include "thimble/driver/result.h"
#include "thimble/driver/serial_arm.h"

namespace thimble::device_sim {

/// The mechanics of the arm with the hand on it. Motors exert torques on the joints; the tip moves
/// as a mass with friction, the same in x, y and z of the base. Frames: B base, T tip, H where the
/// hand wants to be.
///
/// A motor holds its torque over a sub-step. The force at the tip is J_BT^-T tau of the true pose,
/// evaluated once per sub-step, at the point that the tip reaches half-way through at its present
/// velocity. This is the plant's only integration error: second order in the sub-step, relative to
/// the force about (v dt / length)^2, i.e. 1e-6 at 0.1 m/s and 1 ms. Each axis then moves exactly.
class THIMBLE_EXPORT ArmPlant final : public Plant {
 public:
  /// Max. sub-step, ns.
  static constexpr std::int64_t kStepMax_ns = 1'000'000;

  /// Makes the arm at rest at p_BT (m), with the hand wanting to be at p_BH (m). Fails if a
  /// constant is out of range or p_BT out of reach. Real-time: never from the servo thread.
  static driver::Result<ArmPlant> make(const driver::SerialArm& arm,
                                       const std::array<driver::MotorDrive, 3>& drives,
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
  Eigen::Vector3d q() const noexcept override { return pose_.angles(); }
  Eigen::Vector3d q_about() noexcept override;
  const Eigen::Vector3d& currents() const noexcept override { return amperes_; }
  /// Returns the motors' force on the tip in the last sub-step, N. Real-time: safe.
  Eigen::Vector3d f_T_B() const noexcept override { return f_T_B_; }
  std::uint64_t stops() const noexcept override { return stops_; }

  /// Returns the true pose of the links. Real-time: safe.
  const SerialPose& pose() const noexcept { return pose_; }

 private:
  ArmPlant(const driver::SerialArm& arm, const std::array<driver::MotorDrive, 3>& drives,
           const AxisDynamics& dynamics, double current_max, const Eigen::Vector3d& p_BT,
           const Eigen::Vector3d& p_BH) noexcept;
  SerialPose pose_after(double time) const noexcept;

  driver::SerialArm arm_;
  Eigen::Vector3d torque_per_ampere_;  // at the joints, N m/A
  double current_max_;                 // A
  AxisDynamics dynamics_;
  std::array<AxisState, 3> axes_;
  SerialPose pose_;
  SerialPose pose_near_;  // a recent pose whose angles are `q_near_`
  Eigen::Vector3d q_near_;
  Eigen::Vector3d p_BH_;
  Eigen::Vector3d amperes_{0, 0, 0};
  Eigen::Vector3d tau_{0, 0, 0};  // N m
  Eigen::Vector3d f_T_B_{0, 0, 0};
  Eigen::Vector3d pull_B_{0, 0, 0};  // N
  bool driven_ = false;              // any torque is not zero
  std::uint64_t stops_ = 0;
};

}  // namespace thimble::device_sim
