#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "plant/axis_dynamics.h"
#include "plant/link_mechanics.h"
#include "plant/tip_kinematics.h"
#include "thimble/device_sim/settings.h"
#include "thimble/driver/export.h"
#include "thimble/driver/linkage_arm.h"
#include "thimble/driver/result.h"
#include "thimble/driver/serial_arm.h"

namespace thimble::device_sim {

/// A tip that links hang on, or whose joints rub: its mass is the matrix m + G^T M(q) G, which
/// changes with the pose, and its dry friction, along x, y and z of the base and about each joint,
/// is set-valued as AxisDynamics has it (DryFriction).
///
/// A step of dt moves the tip half-way, changes its velocity there, and moves it on
/// (drift, kick, drift): second order in dt. What hangs on the velocity is taken at that half-way
/// through the step, as the acceleration before says. Where an axis comes to rest or breaks loose
/// within a step, friction acts as it does at its end (Moreau's rule), which is of first order: off
/// by at most its momentum c dt. All functions but `make` are Real-time: safe.
class THIMBLE_EXPORT LinkedTip {
 public:
  struct State {
    Eigen::Vector3d p{0, 0, 0};  ///< m
    Eigen::Vector3d v{0, 0, 0};  ///< m/s; exactly 0 in an axis that friction holds.
  };

  /// Makes it at rest at p_BT (m). Fails if a constant is out of range. Links are those of serial
  /// arms; of others none are looked at. Real-time: never from the servo thread.
  static driver::Result<LinkedTip> make(const driver::SerialArm& arm,
                                        const SimulatedArmSettings& settings,
                                        const Eigen::Vector3d& p_BT);
  static driver::Result<LinkedTip> make(const driver::LinkageArm& arm,
                                        const SimulatedArmSettings& settings,
                                        const Eigen::Vector3d& p_BT);

  /// Lets dt_ns pass under a held force (N), the hand's point moving evenly from p_BH (m);
  /// `half_way` is the pose where the tip would be then at its velocity.
  void step(const std::optional<TipPose>& half_way, const Eigen::Vector3d& force,
            const Eigen::Vector3d& p_BH, const Eigen::Vector3d& v_BH, std::int64_t dt_ns) noexcept;

  /// Takes other constants of mass, friction and hand; how it moves stays as it is.
  void take(const AxisDynamics& tip) noexcept;

  const Eigen::Vector3d& p_BT() const noexcept { return state_.p; }
  const Eigen::Vector3d& v_BT() const noexcept { return state_.v; }
  const State& state() const noexcept { return state_; }
  /// Puts it elsewhere (m), moving (m/s).
  void put(const Eigen::Vector3d& p_BT, const Eigen::Vector3d& v_BT) noexcept {
    state_ = {.p = p_BT, .v = v_BT};
    acceleration_.setZero();
  }
  /// Puts it back to where it was, at rest.
  void stop_at(const State& before) noexcept {
    state_ = {.p = before.p, .v = {0, 0, 0}};
    acceleration_.setZero();
  }

 private:
  static driver::Result<LinkedTip> make_of(std::optional<LinkMechanics> links,
                                           const SimulatedArmSettings& settings,
                                           const Eigen::Vector3d& p_BT);
  LinkedTip(std::optional<LinkMechanics> links, const SimulatedArmSettings& settings,
            const Eigen::Vector3d& p_BT) noexcept;

  std::optional<LinkMechanics> links_;
  double mass_;                                                      // of tip and hand, kg
  double coulomb_;                                                   // N
  double viscous_;                                                   // N s/m
  Eigen::Vector3d joint_coulomb_{0, 0, 0}, joint_viscous_{0, 0, 0};  // N m, N m s/rad
  HandSettings hand_;
  State state_;
  Eigen::Vector3d acceleration_{0, 0, 0};  // in the last step, m/s^2
};

}  // namespace thimble::device_sim
