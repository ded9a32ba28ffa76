#pragma once

#include <Eigen/Core>

namespace thimble::device_sim {

/// Dry friction at the tip and in the joints over one step. All that is along its axes holds while
/// it stands and is the most against it while it moves.
struct DryFriction {
  double tip = 0;                               ///< Most along each axis of the base, N s.
  Eigen::Vector3d joints{0, 0, 0};              ///< Most about each joint, N m s.
  Eigen::Matrix3d G = Eigen::Matrix3d::Zero();  ///< d q / d p_BT, rad/m; looked at with `joints`.
};

/// Finds the velocity v (m/s) after a step: inertia v + sum of d_k s_k = momentum, d_k an axis of
/// the base or a row of G, where friction takes any s_k up to its most while d_k v is zero, and the
/// most against it else. It is the one least point of a convex function. Friction of the tip alone
/// is found directly where no axis turns or rests, else by descending along each axis by turns;
/// that of joints by turns among the impulses until it is known which of them hold. `inertia` is
/// symmetric and positive. Real-time: safe.
Eigen::Vector3d velocity_after_friction(const Eigen::Matrix3d& inertia,
                                        const Eigen::Vector3d& momentum,
                                        const DryFriction& friction,
                                        const Eigen::Vector3d& v_before) noexcept;

}  // namespace thimble::device_sim
