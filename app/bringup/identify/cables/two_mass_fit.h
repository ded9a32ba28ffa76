#pragma once

#include <Eigen/Core>

#include "bringup/identify/line_spectrum.h"
#include "bringup/identify/motion_fit.h"

namespace thimble::bringup {

/// Constants of an arm's joints per moved mass, as its lines show them: motors on whose other side,
/// behind cables, the links are. For motor i with the joint torque tau_i,
///
///     J_i q_i'' + b_i q_i' + pull_i = g_i tau_i(t - delay),   pull_i = (k_i + d_i d/dt)(q_i -
///     l_i), J^T J (l'' + b l') = pull,   1/k_i = c_i,   d_i/k_i = t_i.
///
/// Without cables that stretch q = l. What dry friction does to small fast motions looks like
/// viscous friction: b and b_i are no constants of the arm.
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
  double misfit =
      0;  ///< chi^2 per degree of freedom, with the noise that is seen beside the lines.

  /// Returns the natural frequencies of a joint, Hz: of the link on its cable (the motor held), and
  /// of motor and link against each other.
  double antiresonance(int joint, const Eigen::Matrix3d& JTJ) const;
  double resonance(int joint, const Eigen::Matrix3d& JTJ) const;
};

/// What the lines say of the cables.
struct CableFit {
  TwoMass rigid;    ///< The best without a cable that stretches.
  TwoMass elastic;  ///< The best with cables.
  /// The lines tell both apart: by how much the elastic one's Bayesian information is better.
  double better = 0;
  bool stretches = false;  ///< It is so much better that the cables are believed.
  /// Where nothing was seen: cables that let the links oscillate below this would have been, Hz for
  /// each joint.
  Eigen::Vector3d unseen_from{0, 0, 0};
  /// Friction of the motors' side per moved mass, where the motors' motion showed some (PlayFit):
  /// of it lines see a viscous part alone, which differs from line to line.
  Eigen::Vector3d rotor_viscous{0, 0, 0}, rotor_coulomb{0, 0, 0};
  Eigen::Matrix3d JTJ = Eigen::Matrix3d::Zero();  ///< Of the motion, m^2.
  std::vector<Eigen::Vector3d> noise;             ///< RMS beside each line, rad for each joint.
};

/// What the slow part of a motion, fitted to the links behind the cables, says of the same
/// constants, with deviations.
struct SlowPart {
  Eigen::Vector3d gain{0, 0, 0}, gain_error{0, 0, 0};
  Eigen::Vector3d ratio{0, 0, 0}, ratio_error{0, 0, 0};  ///< Inertia over gain.
  double delay = 0, delay_error = 0;                     ///< s
};

/// Fits the cables again, to the lines and the slow part together. Precondition: `found` comes from
/// the same lines. Real-time: never from the servo thread.
void refine_cables(CableFit& found, const LineSpectrum& spectrum, const SlowPart& slow, double dt);

/// Fits both models to the lines of a motion, from what its slow part shows, and chooses by the
/// Bayesian information. Real-time: never from the servo thread.
CableFit fit_cables(const LineSpectrum& spectrum, const PerMass& slow, double dt);

}  // namespace thimble::bringup
