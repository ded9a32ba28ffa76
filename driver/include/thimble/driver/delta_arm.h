#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "thimble/driver/export.h"

namespace thimble::driver {

/// The geometry of a delta arm with three legs, each an upper link and a parallelogram that
/// hangs on two short links, as R. E. Stamper describes it (PhD thesis 97-4, University of
/// Maryland) and libnifalcon has it for the Novint Falcon [S FalconGeometry.h].
///
///   One leg in its own plane (u outwards, w along z; v points out of the page):
///
///     w |        joint 1 at the origin, (r, s) away from the base's axis
///       |     o elbow           a      joint 1 to elbow, at angle q from u
///       |    / \                b      parallelogram, turns out of the plane by its own angle
///       |  a/   \ e + b + d     d, e   short links at both ends of it
///       |  /     \  .           (c, f) from the leg's end to the tip
///       | o q --- \ - - u
///
/// The point where the leg ends lies on a torus around the elbow: distance along u, w minus (d + e)
/// and distance along v make up b. Frame B: origin between the legs, z out of the arm towards the
/// user. Joint vector q: one angle per leg, rad. All functions are Real-time: safe.
struct THIMBLE_EXPORT DeltaArm {
  double a = 0;                     ///< Upper link, m.
  double b = 0;                     ///< Parallelogram, m.
  double c = 0;                     ///< Leg's end to tip along u, m.
  double d = 0;                     ///< Short link at the tip's end, m.
  double e = 0;                     ///< Short link at the elbow's end, m.
  double f = 0;                     ///< Leg's end to tip along v, m.
  double r = 0;                     ///< Base's axis to joint 1 along u, m.
  double s = 0;                     ///< Base's axis to joint 1 along v, m.
  std::array<double, 3> azimuth{};  ///< Direction of each leg's u in the x-y plane, rad.
  /// A tip position well inside the workspace, where the search for the tip begins, m.
  Eigen::Vector3d p_BM{0, 0, 0};

  /// The largest number of steps the search for the tip takes.
  static constexpr int kStepsMax = 40;

  /// Finds the tip p_BT (m) and the Jacobian J_BT = d p_BT / d q (m/rad) from the leg angles, to
  /// below a nanometre. The search begins at `p_BM`; at leg angles that no tip position has, p_BT
  /// and J_BT are NaN, so that everything after it gives zero force.
  void forward(const Eigen::Vector3d& q, Eigen::Vector3d& p_BT,
               Eigen::Matrix3d& J_BT) const noexcept;

  /// Does the same with the search begun at `p_begin` (m); returns the steps it took, or 0 if it
  /// failed.
  int forward_from(const Eigen::Vector3d& p_begin, const Eigen::Vector3d& q, Eigen::Vector3d& p_BT,
                   Eigen::Matrix3d& J_BT) const noexcept;

  /// Returns the rotation R_BL of the plate at the legs' ends, which never turns: the identity.
  Eigen::Matrix3d last_link(const Eigen::Vector3d&, const Eigen::Vector3d&) const noexcept {
    return Eigen::Matrix3d::Identity();
  }

  /// Finds the leg angles that put the tip at p_BT (m), with the elbows outside as the arm is
  /// built. Empty if a leg does not reach the point, or if it is not finite.
  std::optional<Eigen::Vector3d> inverse(const Eigen::Vector3d& p_BT) const noexcept;
};

}  // namespace thimble::driver
