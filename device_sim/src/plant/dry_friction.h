#pragma once

#include <Eigen/Core>

namespace thimble::device_sim {

/// Dry friction at the tip and in the joints over one step. Along each axis it holds the axis at
/// rest, up to its maximum; on a moving axis the maximum acts against the motion.
struct DryFriction {
  double tip = 0;                               ///< Max. along each axis of the base, N s.
  Eigen::Vector3d joints{0, 0, 0};              ///< Max. about each joint, N m s.
  Eigen::Matrix3d G = Eigen::Matrix3d::Zero();  ///< d q / d p_BT, rad/m; used with `joints` only.
};

/// Returns the velocity v (m/s) after a step: inertia v + sum of d_k s_k = momentum, where d_k is
/// an axis of the base or a row of G. While d_k v is zero, s_k takes any value up to its maximum;
/// else it is the maximum, against the motion. The velocity is the unique minimum of a convex
/// function. Friction at the tip only is solved directly if no axis reverses or rests, else by
/// descent along each axis in turn. Friction of the joints is solved by iterating over the impulses
/// until it is known which of them hold. `inertia` is symmetric and positive. Real-time: safe.
Eigen::Vector3d velocity_after_friction(const Eigen::Matrix3d& inertia,
                                        const Eigen::Vector3d& momentum,
                                        const DryFriction& friction,
                                        const Eigen::Vector3d& v_before) noexcept;

}  // namespace thimble::device_sim
