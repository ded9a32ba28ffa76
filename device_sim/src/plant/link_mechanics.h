#pragma once

#include <Eigen/Core>

#include "thimble/device_sim/settings.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/driver/serial_arm.h"

namespace thimble::device_sim {

/// Dynamics of the links of a serial arm at a pose and joint rates.
struct LinkMotion {
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< M(q) of the links only, kg m^2.
  /// Torque of gravity and joint rates on the joints, g(q) - C(q, q') q', N m.
  Eigen::Vector3d torque{0, 0, 0};
  /// Acceleration of the tip at constant joint rates, J' q', m/s^2 in the base.
  Eigen::Vector3d turning{0, 0, 0};
};

/// The equations of motion of the links of a serial arm with the constants of LinkSettings:
/// Lagrange's equations of its kinetic energy and potential,
///
///     M(q) q'' + C(q, q') q' - g(q) = tau.
///
/// This is the form that [Cavusoglu] gives for the PHANTOM, with its sums of masses and lengths
/// combined: 2 T = q'^T M q' with
///
///     M_AA = I_A + Y_B sin^2 B + Y_C sin^2 C + 2 K sin B sin C,
///     M_BB = I_B,  M_CC = I_C,  M_BC = K cos(B + C).
class THIMBLE_EXPORT LinkMechanics {
 public:
  /// Takes constants that `check_links` accepts. Real-time: safe.
  LinkMechanics(const driver::SerialArm& arm, const LinkSettings& links) noexcept
      : arm_(arm), links_(links) {}

  /// Returns the dynamics at joint angles q (rad) with joint rates `rate` (rad/s). Real-time: safe.
  LinkMotion at(const Eigen::Vector3d& q, const Eigen::Vector3d& rate) const noexcept;

 private:
  driver::SerialArm arm_;
  LinkSettings links_;
};

/// Returns an error if the constants are impossible: one is not finite, or kinetic energy would be
/// below zero in some pose. Real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<void> check_links(const LinkSettings& links);

}  // namespace thimble::device_sim
