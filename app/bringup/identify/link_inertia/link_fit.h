#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "bringup/estimate.h"
#include "bringup/identify/arm_motion.h"
#include "thimble/driver/result.h"
#include "thimble/driver/serial_arm.h"

namespace thimble::bringup {

/// Constants of a serial arm with links, from its motion at several poses:
///
///     m p'' + G^T (M(q) q'' + C(q, q') q') = sum_i g_i G_i^T tau_i(t - delay) - b p' - c sgn(p')
///                                            + w + G^T J_1^T moment_b gravity,
///
/// M, C and the moment are those of device_sim::LinkSettings without coupling and moment_c, which
/// motion does not distinguish from mass and weight at the tip. `mass` includes them here, so
/// inertia C or yaw_c may be below zero. Apparent masses do not depend on that convention.
struct LinkFit {
  /// Index of each constant in `theta`: kg, kg m^2, kg m, N s/m, N, N, gains.
  enum Index {
    kMass = 0,
    kInertia = 1,
    kYawB = 4,
    kYawC = 5,
    kMomentB = 6,
    kViscous = 7,
    kCoulomb = 8,
    kWeight = 9,
    kGain = 12,
    kCount = 15
  };

  driver::SerialArm arm;
  Eigen::Matrix<double, kCount, 1> theta = Eigen::Matrix<double, kCount, 1>::Zero();
  Eigen::Matrix<double, kCount, kCount> covariance = Eigen::Matrix<double, kCount, kCount>::Zero();
  Estimate delay;         ///< Delay from the force to the motion that the host sees, s.
  bool absolute = false;  ///< A known mass gave the scale; if not, the gains' geometric mean is 1.
  /// Gain of the Bayesian information criterion by links over a point mass, by Wald's statistic.
  double better = 0;
  bool links = false;     ///< Links are accepted; if not, the constants are those of a point mass.
  double max_change = 0;  ///< Max. relative difference of masses between poses, 95 %; of links.
  double residual = 0;    ///< RMS residual of the force, N.
  double explained = 0;   ///< Share of the motors' force that the model explains.
  std::size_t windows = 0;  ///< Number of fitted pieces of motion.

  /// Pose of one of the motions.
  struct Place {
    Eigen::Vector3d q{0, 0, 0};  ///< Joint angles in its middle, rad.
    /// Ratio of the mass seen there along each axis of the base to that of the constants.
    std::array<Estimate, 3> seen;
  };
  std::vector<Place> places;  ///< Of the motions with a bare tip, in their order.

  /// Returns a constant of `theta` with its statistical interval.
  Estimate constant(int index) const {
    return {theta[index], kNormal95 * std::sqrt(covariance(index, index))};
  }

  /// Returns the diagonal of the tip's mass matrix m + G^T M G at joint angles q, kg. It is the
  /// force along an axis of the base for an acceleration along that axis only. Real-time: never
  /// from the servo thread.
  std::array<Estimate, 3> apparent_mass(const Eigen::Vector3d& q) const;
};

/// Fits motions at several poses together, in the weak form like `fit_motion`; some may have a
/// known mass on the tip. Fails if they are too short, at too few poses, or torn. Real-time: never
/// from the servo thread.
driver::Result<LinkFit> fit_links(const driver::SerialArm& arm,
                                  const std::vector<ArmMotion>& motions);

}  // namespace thimble::bringup
