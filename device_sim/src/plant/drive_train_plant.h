#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "plant/axis_dynamics.h"
#include "plant/drive_train.h"
#include "plant/linked_tip.h"
#include "plant/plant.h"
#include "plant/point_tip.h"
#include "plant/tip_kinematics.h"
#include "thimble/device_sim/settings.h"
#include "thimble/driver/export.h"
#include "thimble/driver/joint_model.h"
#include "thimble/driver/linkage_arm.h"
#include "thimble/driver/result.h"
#include "thimble/driver/serial_arm.h"

namespace thimble::device_sim {

/// State of motion of an arm with a drive train.
struct DriveTrainState {
  Eigen::Vector3d p_BT{0, 0, 0};     ///< Position of the tip, m.
  Eigen::Vector3d v_BT{0, 0, 0};     ///< Velocity of the tip, m/s.
  Eigen::Vector3d q_rotor{0, 0, 0};  ///< Rotors, rad at the joints; ignored without elastic cables.
  Eigen::Vector3d rate_rotor{0, 0, 0};  ///< Their rates, rad/s; ignored without elastic cables.
  Eigen::Vector3d amperes{0, 0, 0};     ///< Currents in the motors, A.
};

/// The mechanics of an arm with a simulated drive train, weight or links, with a hand on it. The
/// tip is the mass of ArmPlant (PointTip), or one with links or with friction in the joints
/// (LinkedTip). Without elastic cables the motors act on it directly. With them each motor is a
/// mass of its own, and the encoders, which are mounted on the motors, measure the motors' angles.
///
/// Time passes in sub-steps of at most 25 us, or of the length given to `make`. In each, all forces
/// but friction, hand and anchor are held at their value half-way, where tip and rotors would be
/// then at their present velocities. Then every axis moves exactly (AxisDynamics), a tip with links
/// by LinkedTip's rule. For a spring between masses that is the Stoermer-Verlet rule. It neither
/// gains nor loses energy, and a resonance of w (rad/s) is too high by (w 25 us)^2 / 24, 1e-5 at
/// 100 Hz. Defined for SerialArm, LinkageArm and
/// BoardGeometry, with links for SerialArm. All functions but `make`
/// are Real-time: safe.
template <class Geometry, class Tip = PointTip>
class THIMBLE_EXPORT DriveTrainPlant final : public Plant {
 public:
  /// Default max. sub-step, ns.
  static constexpr std::int64_t kSubStep_ns = 25'000;

  /// Makes the arm at rest at p_BT (m), its cables without stretch. The hand wants to be at p_BH
  /// (m). Sub-steps are at most `sub_step_ns` > 0. Fails if a constant is out of range or p_BT out
  /// of reach. Real-time: never from the servo thread.
  static driver::Result<DriveTrainPlant> make(const driver::JointModel<Geometry>& model,
                                              const SimulatedArmSettings& settings,
                                              const Eigen::Vector3d& p_BT,
                                              const Eigen::Vector3d& p_BH,
                                              std::int64_t sub_step_ns = kSubStep_ns);

  /// Sets pose and motion of the arm; a tip out of reach changes nothing. The motors keep their
  /// temperatures.
  void put(const DriveTrainState& state) noexcept;

  void set_currents(const Eigen::Vector3d& amperes) noexcept override { train_.ask(amperes); }
  void step(const Eigen::Vector3d& p_BH, std::int64_t dt_ns) noexcept override;
  void take_tip(const AxisDynamics& tip) noexcept override { tip_.take(tip); }
  void set_pull(const Eigen::Vector3d& f_T_B) noexcept override { weight_B_ = f_T_B; }
  Eigen::Vector3d p_BT() const noexcept override { return tip_.p_BT(); }
  Eigen::Vector3d v_BT() const noexcept override { return tip_.v_BT(); }
  const Eigen::Vector3d& p_BH() const noexcept override { return p_BH_; }
  /// Returns the angles of the rotors, rad at the joints, as the encoders measure them.
  Eigen::Vector3d q() const noexcept override { return rotor(); }
  const Eigen::Vector3d& currents() const noexcept override { return train_.currents(); }
  /// Returns the force of the cables on the tip in the last sub-step, N.
  Eigen::Vector3d f_T_B() const noexcept override { return f_T_B_; }
  Eigen::Vector3d winding_rise() const noexcept override { return train_.winding_rise(); }
  std::uint64_t stops() const noexcept override { return stops_; }

 private:
  DriveTrainPlant(const driver::JointModel<Geometry>& model, const SimulatedArmSettings& settings,
                  const DriveTrain& train, const Tip& tip,
                  const std::array<AxisDynamics, 3>& rotors, const Eigen::Vector3d& p_BH,
                  const TipPose& pose, std::int64_t sub_step_ns) noexcept;

  Eigen::Vector3d rotor() const noexcept { return {rotor_[0].x, rotor_[1].x, rotor_[2].x}; }
  Eigen::Vector3d rotor_rate() const noexcept { return {rotor_[0].v, rotor_[1].v, rotor_[2].v}; }
  void sub_step(const Eigen::Vector3d& v_BH, std::int64_t dt_ns) noexcept;
  void turn_rotors(const Eigen::Vector3d& motor, const Eigen::Vector3d& cable,
                   std::int64_t dt_ns) noexcept;
  Eigen::Vector3d cable_pull(const TipPose& half_way, const Eigen::Vector3d& rotor) noexcept;

  Geometry geometry_;
  Eigen::Vector3d weight_B_;  // N
  bool compliant_;
  DriveTrain train_;
  Tip tip_;
  std::array<AxisDynamics, 3> rotor_dynamics_;  // of elastic cables
  std::array<AxisState, 3> rotor_;              // rad at the joint
  Eigen::Vector3d rate_before_{0, 0, 0};        // of the cable stretch, one sub-step ago, rad/s
  Eigen::Vector3d p_BH_;
  Eigen::Vector3d f_T_B_{0, 0, 0};
  std::int64_t sub_step_ns_;
  std::uint64_t stops_ = 0;
};

using SerialDriveTrainPlant = DriveTrainPlant<driver::SerialArm>;
using LinkedSerialPlant = DriveTrainPlant<driver::SerialArm, LinkedTip>;
using LinkageDriveTrainPlant = DriveTrainPlant<driver::LinkageArm>;
using RubbingLinkagePlant = DriveTrainPlant<driver::LinkageArm, LinkedTip>;
using BoardDriveTrainPlant = DriveTrainPlant<BoardGeometry>;
using RubbingBoardPlant = DriveTrainPlant<BoardGeometry, LinkedTip>;

}  // namespace thimble::device_sim
