#include "bringup/identify/cables/backlash/gap_constants.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bringup/identify/arm_constants.h"

namespace thimble::bringup {

GapTheta::Vector gap_constants(const PerMass& rigid, const CableFit& lines) {
  const Eigen::Matrix<double, TwoMass::kCount, 1>& seen = lines.elastic.theta;
  GapTheta::Vector theta = GapTheta::Vector::Zero();
  for (int i = 0; i < 3; ++i) {
    const double fast = seen[TwoMass::kGain + i] / seen[TwoMass::kInertia + i];
    const double slow = rigid.theta[PerMass::kGain + i];
    const double inertia = slow / std::max(0.05 * fast, fast - slow / lines.JTJ(i, i));
    const double stiffness = 1 / seen[TwoMass::kCompliance + i];
    theta[GapTheta::kGain + i] = fast * inertia;
    theta[GapTheta::kInertia + i] = inertia;
    theta[GapTheta::kStiffness + i] = stiffness;
    theta[GapTheta::kDamping + i] = stiffness * std::max(1e-5, seen[TwoMass::kFade + i]);
    theta[GapTheta::kWeight + i] = rigid.theta[PerMass::kWeight + i];
  }
  theta[GapTheta::kDelay] = seen[TwoMass::kDelay];
  theta[GapTheta::kViscous] = std::max(0.0, rigid.theta[PerMass::kViscous]);
  theta[GapTheta::kCoulomb] = std::max(0.0, rigid.theta[PerMass::kCoulomb]);
  return theta;
}

PerMass per_mass_of(const GapFit& fit, const ArmMotion& motion) {
  constexpr std::pair<int, int> kSame[] = {{PerMass::kGain, GapTheta::kGain},
                                           {PerMass::kGain + 1, GapTheta::kGain + 1},
                                           {PerMass::kGain + 2, GapTheta::kGain + 2},
                                           {PerMass::kViscous, GapTheta::kViscous},
                                           {PerMass::kCoulomb, GapTheta::kCoulomb},
                                           {PerMass::kWeight, GapTheta::kWeight},
                                           {PerMass::kWeight + 1, GapTheta::kWeight + 1},
                                           {PerMass::kWeight + 2, GapTheta::kWeight + 2},
                                           {PerMass::kStiffness, GapTheta::kSpring}};
  PerMass found;
  for (const auto& [to, from] : kSame) {
    found.theta[to] = fit.theta[from];
    for (const auto& [other_to, other_from] : kSame) {
      found.covariance(to, other_to) = fit.covariance(from, other_from);
    }
  }
  found.delay = {fit.theta[GapTheta::kDelay],
                 kNormal95 * std::sqrt(fit.covariance(GapTheta::kDelay, GapTheta::kDelay))};
  found.windows = fit.pieces;
  found.left_out = static_cast<std::size_t>(fit.lost * static_cast<double>(found.windows));
  // From the angles, for a fit without known accelerations.
  double square = 0;
  Eigen::Vector3d mean(0, 0, 0);
  for (const MotionSample& sample : motion.samples) mean += sample.q;
  mean /= static_cast<double>(motion.samples.size());
  for (const MotionSample& sample : motion.samples) {
    square += (sample.q - mean).squaredNorm() / static_cast<double>(motion.samples.size());
  }
  found.noise = motion.step.norm() / std::sqrt(12.0);
  found.residual = std::sqrt(fit.misfit) * found.noise;
  found.explained = 1 - found.residual * found.residual / square;
  return found;
}

TwoMass two_mass_of(const GapFit& fit, const TwoMass& before) {
  TwoMass found = before;
  Eigen::Matrix<double, TwoMass::kCount, GapTheta::kCount> slope;
  slope.setZero();
  const auto take = [&](int to, int from) {
    found.theta[to] = fit.theta[from];
    slope(to, from) = 1;
  };
  take(TwoMass::kDelay, GapTheta::kDelay);
  take(TwoMass::kViscous, GapTheta::kViscous);
  for (int i = 0; i < 3; ++i) {
    take(TwoMass::kGain + i, GapTheta::kGain + i);
    take(TwoMass::kInertia + i, GapTheta::kInertia + i);
    // Lines contain the dry friction with which they were fitted.
    if (fit.theta.tail<6>().isZero(0)) found.theta[TwoMass::kRotorViscous + i] = 0;
    const double stiffness = fit.theta[GapTheta::kStiffness + i],
                 damping = fit.theta[GapTheta::kDamping + i];
    found.theta[TwoMass::kCompliance + i] = 1 / stiffness;
    found.theta[TwoMass::kFade + i] = damping / stiffness;
    slope(TwoMass::kCompliance + i, GapTheta::kStiffness + i) = -1 / (stiffness * stiffness);
    slope(TwoMass::kFade + i, GapTheta::kDamping + i) = 1 / stiffness;
    slope(TwoMass::kFade + i, GapTheta::kStiffness + i) = -damping / (stiffness * stiffness);
  }
  found.covariance = slope * fit.covariance * slope.transpose();
  found.misfit = fit.misfit;
  return found;
}

}  // namespace thimble::bringup
