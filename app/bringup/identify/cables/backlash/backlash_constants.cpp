#include "bringup/identify/cables/backlash/backlash_constants.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bringup/identify/arm_constants.h"

namespace thimble::bringup {

BacklashTheta::Vector backlash_constants(const MassNormalisedFit& rigid, const CableFit& lines) {
  const Eigen::Matrix<double, TwoMass::kCount, 1>& seen = lines.elastic.theta;
  BacklashTheta::Vector theta = BacklashTheta::Vector::Zero();
  for (int i = 0; i < 3; ++i) {
    const double fast = seen[TwoMass::kGain + i] / seen[TwoMass::kInertia + i];
    const double slow = rigid.theta[MassNormalisedFit::kGain + i];
    const double inertia = slow / std::max(0.05 * fast, fast - slow / lines.JTJ(i, i));
    const double stiffness = 1 / seen[TwoMass::kCompliance + i];
    theta[BacklashTheta::kGain + i] = fast * inertia;
    theta[BacklashTheta::kInertia + i] = inertia;
    theta[BacklashTheta::kStiffness + i] = stiffness;
    theta[BacklashTheta::kDamping + i] = stiffness * std::max(1e-5, seen[TwoMass::kFade + i]);
    theta[BacklashTheta::kWeight + i] = rigid.theta[MassNormalisedFit::kWeight + i];
  }
  theta[BacklashTheta::kDelay] = seen[TwoMass::kDelay];
  theta[BacklashTheta::kViscous] = std::max(0.0, rigid.theta[MassNormalisedFit::kViscous]);
  theta[BacklashTheta::kCoulomb] = std::max(0.0, rigid.theta[MassNormalisedFit::kCoulomb]);
  return theta;
}

MassNormalisedFit mass_normalised_fit_of(const BacklashFit& fit, const ArmMotion& motion) {
  constexpr std::pair<int, int> kSame[] = {
      {MassNormalisedFit::kGain, BacklashTheta::kGain},
      {MassNormalisedFit::kGain + 1, BacklashTheta::kGain + 1},
      {MassNormalisedFit::kGain + 2, BacklashTheta::kGain + 2},
      {MassNormalisedFit::kViscous, BacklashTheta::kViscous},
      {MassNormalisedFit::kCoulomb, BacklashTheta::kCoulomb},
      {MassNormalisedFit::kWeight, BacklashTheta::kWeight},
      {MassNormalisedFit::kWeight + 1, BacklashTheta::kWeight + 1},
      {MassNormalisedFit::kWeight + 2, BacklashTheta::kWeight + 2},
      {MassNormalisedFit::kStiffness, BacklashTheta::kSpring}};
  MassNormalisedFit found;
  for (const auto& [to, from] : kSame) {
    found.theta[to] = fit.theta[from];
    for (const auto& [other_to, other_from] : kSame) {
      found.covariance(to, other_to) = fit.covariance(from, other_from);
    }
  }
  found.delay = {
      fit.theta[BacklashTheta::kDelay],
      kNormal95 * std::sqrt(fit.covariance(BacklashTheta::kDelay, BacklashTheta::kDelay))};
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

TwoMass two_mass_of(const BacklashFit& fit, const TwoMass& before) {
  TwoMass found = before;
  Eigen::Matrix<double, TwoMass::kCount, BacklashTheta::kCount> slope;
  slope.setZero();
  const auto take = [&](int to, int from) {
    found.theta[to] = fit.theta[from];
    slope(to, from) = 1;
  };
  take(TwoMass::kDelay, BacklashTheta::kDelay);
  take(TwoMass::kViscous, BacklashTheta::kViscous);
  for (int i = 0; i < 3; ++i) {
    take(TwoMass::kGain + i, BacklashTheta::kGain + i);
    take(TwoMass::kInertia + i, BacklashTheta::kInertia + i);
    // Lines contain the dry friction with which they were fitted.
    if (fit.theta.tail<6>().isZero(0)) found.theta[TwoMass::kRotorViscous + i] = 0;
    const double stiffness = fit.theta[BacklashTheta::kStiffness + i],
                 damping = fit.theta[BacklashTheta::kDamping + i];
    found.theta[TwoMass::kCompliance + i] = 1 / stiffness;
    found.theta[TwoMass::kFade + i] = damping / stiffness;
    slope(TwoMass::kCompliance + i, BacklashTheta::kStiffness + i) = -1 / (stiffness * stiffness);
    slope(TwoMass::kFade + i, BacklashTheta::kDamping + i) = 1 / stiffness;
    slope(TwoMass::kFade + i, BacklashTheta::kStiffness + i) = -damping / (stiffness * stiffness);
  }
  found.covariance = slope * fit.covariance * slope.transpose();
  found.misfit = fit.misfit;
  return found;
}

}  // namespace thimble::bringup
