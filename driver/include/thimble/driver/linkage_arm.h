#pragma once

#include <Eigen/Core>
#include <optional>

#include "thimble/driver/export.h"

namespace thimble::driver {

/// Geometry of the Polhem arm: a yaw joint, and in its plane two motors next to each other that
/// move the forearm through a four-bar linkage [S forsslund/hfabapi hfab_polhem.h].
///
///     h |            elbow            bar 1 from the front motor to the elbow, at angle q1
///       |      1   . o - - -forearm-> T   length_5 from elbow to tip, at angle lambda
///       |     .   / 4                 bar 4 continues the forearm backwards
///       |  . o - o                    bar 2 on the back motor, at angle q2
///       | o 2  3                      bar 3 joins the ends of 2 and 4
///   --- back - - front - - r          the motors are length_0 apart, the yaw axis half-way
///
/// Frame B: origin on the yaw axis between the motors, z up. Joint vector q = (yaw, q1, q2), rad,
/// both link angles measured from the r axis. All functions are Real-time: safe.
struct THIMBLE_EXPORT LinkageArm {
  double length_0 = 0;  ///< Between the two motors, m.
  double length_1 = 0;  ///< Front motor to elbow, m.
  double length_2 = 0;  ///< Crank on the back motor, m.
  double length_3 = 0;  ///< Coupling bar, m.
  double length_4 = 0;  ///< Elbow back to the coupling bar, m.
  double length_5 = 0;  ///< Elbow to tip, m.

  /// Computes the tip p_BT (m) and the Jacobian J_BT = d p_BT / d q (m/rad). If the bars cannot
  /// close, both are NaN, so that all later stages give zero force.
  void forward(const Eigen::Vector3d& q, Eigen::Vector3d& p_BT,
               Eigen::Matrix3d& J_BT) const noexcept;

  /// Returns the rotation R_BL of the forearm: x along it towards the tip, y level [S
  /// forsslund/hfabapi hfab_api.cpp, getRot]. NaN if the bars cannot close.
  Eigen::Matrix3d last_link(const Eigen::Vector3d& q, const Eigen::Vector3d& p_BT) const noexcept;

  /// Returns the joint angles at which the tip is at p_BT (m). The configuration is that in which
  /// the arm is built: elbow above the line from the front motor to the tip, crank behind its bar.
  /// Empty if the bars do not reach the point, or if it is not finite.
  std::optional<Eigen::Vector3d> inverse(const Eigen::Vector3d& p_BT) const noexcept;
};

}  // namespace thimble::driver
