#pragma once

#include <Eigen/Core>

#include "bringup/identify/line_spectrum.h"
#include "bringup/identify/motion_fit.h"

namespace thimble::bringup {

/// Constants of an arm's joints per moved mass, from its lines: motors that drive the links through
/// cables. For motor i with the joint torque tau_i,
///
///     J_i q_i'' + b_i q_i' + pull_i = g_i tau_i(t - delay),   pull_i = (k_i + d_i d/dt)(q_i -
///     l_i), J^T J (l'' + b l') = pull,   1/k_i = c_i,   d_i/k_i = t_i.
///
/// Without elastic cables q = l. In small fast motions dry friction looks like viscous friction, so
/// b and b_i are not constants of the arm.
struct TwoMass {
  enum Index {
    kGain = 0,
    kViscous = 3,
    kDelay = 4,
    kInertia = 5,
    kRotorViscous = 8,
    kCompliance = 11,
    kFade = 14,
    kCount = 17
  };
  static constexpr int kRigidCount = kCompliance;

  Eigen::Matrix<double, kCount, 1> theta = Eigen::Matrix<double, kCount, 1>::Zero();
  Eigen::Matrix<double, kCount, kCount> covariance = Eigen::Matrix<double, kCount, kCount>::Zero();
  double misfit = 0;  ///< chi^2 per degree of freedom, relative to the noise between the lines.

  /// Returns the natural frequencies of a joint, Hz: of the link on its cable (motor held), and of
  /// motor and link against each other.
  double antiresonance(int joint, const Eigen::Matrix3d& JTJ) const;
  double resonance(int joint, const Eigen::Matrix3d& JTJ) const;
};

/// Result of the lines about the cables.
struct CableFit {
  TwoMass rigid;    ///< Best fit without elastic cables.
  TwoMass elastic;  ///< Best fit with cables.
  /// Gain of the Bayesian information criterion by elastic cables; the lines distinguish both
  /// models.
  double better = 0;
  bool stretches = false;  ///< The gain suffices to accept the cables.
  /// If nothing was seen: cables would have been seen whose links oscillate below this frequency,
  /// Hz for each joint.
  Eigen::Vector3d unseen_from{0, 0, 0};
  /// Friction of the motors' side per moved mass, if the motors' motion showed some
  /// (BacklashResult). Lines show only a viscous part of it, which differs from line to line.
  Eigen::Vector3d rotor_viscous{0, 0, 0}, rotor_coulomb{0, 0, 0};
  Eigen::Matrix3d JTJ = Eigen::Matrix3d::Zero();  ///< Mean over the motion, m^2.
  std::vector<Eigen::Vector3d> noise;             ///< RMS between the lines, rad for each joint.
};

/// Values of the same constants, with deviations, from the slow part of a motion that was fitted to
/// the links behind the cables.
struct SlowPart {
  Eigen::Vector3d gain{0, 0, 0}, gain_error{0, 0, 0};
  Eigen::Vector3d ratio{0, 0, 0}, ratio_error{0, 0, 0};  ///< Inertia over gain.
  double delay = 0, delay_error = 0;                     ///< s
};

/// Fits the cables again, to the lines and the slow part together. Precondition: `found` comes from
/// the same lines. Real-time: never from the servo thread.
void refine_cables(CableFit& found, const LineSpectrum& spectrum, const SlowPart& slow, double dt);

/// Fits both models to the lines of a motion, starting from its slow part, and selects one by the
/// Bayesian information criterion. Real-time: never from the servo thread.
CableFit fit_cables(const LineSpectrum& spectrum, const MassNormalisedFit& slow, double dt);

}  // namespace thimble::bringup
