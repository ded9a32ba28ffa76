#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "plant/axis_dynamics.h"
#include "plant/board_geometry.h"
#include "plant/link_mechanics.h"
#include "plant/tip_kinematics.h"
#include "thimble/device_sim/settings.h"
#include "thimble/driver/export.h"
#include "thimble/driver/linkage_arm.h"
#include "thimble/driver/result.h"
#include "thimble/driver/serial_arm.h"

namespace thimble::device_sim {

/// A tip with links, or with friction in the joints. Its mass is the matrix m + G^T M(q) G, which
/// changes with the pose. Its dry friction, along x, y and z of the base and about each joint, is
/// set-valued as in AxisDynamics (DryFriction).
///
/// A step of dt moves the tip half-way, changes its velocity there, and moves it on (drift, kick,
/// drift): second order in dt. Velocity-dependent terms use the velocity half-way through the step,
/// extrapolated with the previous acceleration. If an axis comes to rest or breaks loose within a
/// step, friction acts as at the end of the step (Moreau's rule). That is of first order: the error
/// is at most its momentum c dt. All functions but `make` are Real-time: safe.
class THIMBLE_EXPORT LinkedTip {
 public:
  struct State {
    Eigen::Vector3d p{0, 0, 0};  ///< m
    Eigen::Vector3d v{0, 0, 0};  ///< m/s; exactly 0 in an axis that friction holds.
  };

  /// Makes the tip at rest at p_BT (m). Fails if a constant is out of range. Links are those of
  /// serial arms; for other arms they are ignored. Real-time: never from the servo thread.
  static driver::Result<LinkedTip> make(const driver::SerialArm& arm,
                                        const SimulatedArmSettings& settings,
                                        const Eigen::Vector3d& p_BT);
  static driver::Result<LinkedTip> make(const driver::LinkageArm& arm,
                                        const SimulatedArmSettings& settings,
                                        const Eigen::Vector3d& p_BT);
  static driver::Result<LinkedTip> make(const BoardGeometry& arm,
                                        const SimulatedArmSettings& settings,
                                        const Eigen::Vector3d& p_BT);

  /// Advances by dt_ns under a held force (N), while the hand's point moves from p_BH (m) at
  /// constant velocity. `half_way` is the pose that the tip would reach half-way at its velocity.
  void step(const std::optional<TipPose>& half_way, const Eigen::Vector3d& force,
            const Eigen::Vector3d& p_BH, const Eigen::Vector3d& v_BH, std::int64_t dt_ns) noexcept;

  /// Sets other constants of mass, friction and hand; the motion continues unchanged.
  void take(const AxisDynamics& tip) noexcept;

  const Eigen::Vector3d& p_BT() const noexcept { return state_.p; }
  const Eigen::Vector3d& v_BT() const noexcept { return state_.v; }
  const State& state() const noexcept { return state_; }
  /// Sets position (m) and velocity (m/s).
  void put(const Eigen::Vector3d& p_BT, const Eigen::Vector3d& v_BT) noexcept {
    state_ = {.p = p_BT, .v = v_BT};
    acceleration_.setZero();
  }
  /// Returns to an earlier position, at rest.
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
