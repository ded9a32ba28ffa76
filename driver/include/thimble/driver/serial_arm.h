#pragma once

#include <Eigen/Core>
#include <optional>

#include "thimble/driver/export.h"

namespace thimble::driver {

/// Geometry of a serial arm of the PHANTOM family: a yaw A and two links B and C. Both link angles
/// are measured from the ground, because a parallel linkage carries the second link [hfab
/// kinematics].
///
///          z_B            r = length_b sin(B) + length_c sin(C)
///           |  B  / link b
///           |    /        x = r cos(A),  y = r sin(A)
///           |   /         z = height + length_b cos(B) - length_c cos(C)
///           |  /\ .
///           | /  \ .      B = 0: link b points up;  C = 0: link c hangs down.
///       ----+     \ link c
///        base      T
///
/// Frame B: origin on the yaw axis, x towards the user, y to the user's right, z up. Angles in rad.
/// Joint vector q = (A, B, C). All functions are Real-time: safe.
struct THIMBLE_EXPORT SerialArm {
  double height = 0;    ///< Height of the shoulder above the base's origin (Ln), m.
  double length_b = 0;  ///< Length of the first link (Lb), m.
  double length_c = 0;  ///< Length of the second link up to the tip (Lc), m.

  /// Returns the tip p_BT, m, at joint angles `q`.
  Eigen::Vector3d forward(const Eigen::Vector3d& q) const noexcept;

  /// Returns the Jacobian J_BT = d p_BT / d q, m/rad, so that v_BT = J_BT qdot and tau = J_BT^T
  /// f_T_B.
  Eigen::Matrix3d jacobian(const Eigen::Vector3d& q) const noexcept;

  /// Computes `forward` and `jacobian` together, at the cost of one.
  void forward(const Eigen::Vector3d& q, Eigen::Vector3d& p_BT,
               Eigen::Matrix3d& J_BT) const noexcept;

  /// Returns the rotation R_BL of the second link: x along it towards the tip, y level and to the
  /// user's right if the arm points at the user [S forsslund/haptikfabrikenapi kinematics.cpp,
  /// computeRotation: a turn about y by 90 degrees less C, "need verification"].
  Eigen::Matrix3d last_link(const Eigen::Vector3d& q, const Eigen::Vector3d& p_BT) const noexcept;

  /// Returns the joint angles at which the tip is at p_BT (m), on the branch 0 < B + C < pi in
  /// which such an arm works (folded at 0, stretched at pi, isotropic in between). Empty if the
  /// point is out of reach, on the yaw axis, or not finite.
  std::optional<Eigen::Vector3d> inverse(const Eigen::Vector3d& p_BT) const noexcept;
};

}  // namespace thimble::driver
