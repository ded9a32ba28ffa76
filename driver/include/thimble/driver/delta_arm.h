#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "thimble/driver/export.h"

namespace thimble::driver {

/// Geometry of a delta arm with three legs, each an upper link and a parallelogram on two short
/// links. As described by R. E. Stamper (PhD thesis 97-4, University of Maryland), and in
/// libnifalcon for the Novint Falcon [S FalconGeometry.h].
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
/// The end of the leg lies on a torus around the elbow: distance along u, w minus (d + e) and
/// distance along v make up b. Frame B: origin between the legs, z out of the arm towards the user.
/// Joint vector q: one angle per leg, rad. All functions are Real-time: safe.
struct THIMBLE_EXPORT DeltaArm {
  double a = 0;  ///< Upper link, m.
  double b = 0;  ///< Parallelogram, m.
  double c = 0;  ///< Leg's end to tip along u, m.
  double d = 0;  ///< Short link at the tip's end, m.
  double e = 0;  ///< Short link at the elbow's end, m.
  double f = 0;  ///< Leg's end to tip along v, m.
  double r = 0;  ///< Base's axis to joint 1 along u, m.
  double s = 0;  ///< Base's axis to joint 1 along v, m.
  /// Unit vector of each leg's u in the x-y plane. Computed once, because a sine takes a tenth of
  /// the time of `forward`.
  std::array<Eigen::Vector2d, 3> outwards{Eigen::Vector2d::UnitX(), Eigen::Vector2d::UnitX(),
                                          Eigen::Vector2d::UnitX()};
  /// Point on the side of the legs where the tip is, m; well inside the workspace.
  Eigen::Vector3d p_BM{0, 0, 0};

  /// Largest number of steps of the search for the tip.
  static constexpr int kStepsMax = 40;

  /// Computes the tip p_BT (m), to below a nanometre, and the Jacobian J_BT = d p_BT / d q (m/rad)
  /// from the leg angles. The search starts on three spheres, on the side of `p_BM`, and takes 3 to
  /// 5 steps. If no tip position has these angles, p_BT and J_BT are NaN, so that all later stages
  /// give zero force.
  void forward(const Eigen::Vector3d& q, Eigen::Vector3d& p_BT,
               Eigen::Matrix3d& J_BT) const noexcept;

  /// Does the same with a search that starts at `p_begin` (m). Returns the number of steps, or 0 if
  /// it failed.
  int forward_from(const Eigen::Vector3d& p_begin, const Eigen::Vector3d& q, Eigen::Vector3d& p_BT,
                   Eigen::Matrix3d& J_BT) const noexcept;

  /// Returns the rotation R_BL of the plate at the ends of the legs: the identity, because the
  /// plate never rotates.
  Eigen::Matrix3d last_link(const Eigen::Vector3d&, const Eigen::Vector3d&) const noexcept {
    return Eigen::Matrix3d::Identity();
  }

  /// Returns the leg angles at which the tip is at p_BT (m), with the elbows outside as the arm is
  /// built. Empty if a leg does not reach the point, or if it is not finite.
  std::optional<Eigen::Vector3d> inverse(const Eigen::Vector3d& p_BT) const noexcept;
};

}  // namespace thimble::driver
