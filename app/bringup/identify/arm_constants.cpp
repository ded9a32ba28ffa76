#include "bringup/identify/arm_constants.h"

#include <Eigen/Cholesky>
#include <cmath>

#include "gravity_terms.h"
#include "math/elementary.h"

namespace thimble::bringup {
namespace {

constexpr int kSeen = 8;  // number of measured constants per mass: all but the stiffness
// Number of unknowns: mass, three gains, viscous, Coulomb, three components of the weight
constexpr int kWanted = 9;

using Seen = Eigen::Matrix<double, kSeen, 1>;
using Wanted = Eigen::Matrix<double, kWanted, 1>;
using Slope = Eigen::Matrix<double, kSeen, kWanted>;

/// Constants per mass of the motion of an arm with these constants, and their derivatives.
Seen shown(const Wanted& x, double added, const Eigen::Vector3d& down_B, Slope& slope) {
  const double over = 1 / (x[0] + added);
  Seen z = x.tail<kSeen>();
  z.tail<3>() += added * scene::kGravity * down_B;
  z *= over;
  slope.setZero();
  slope.col(0) = -over * z;
  slope.rightCols<kSeen>() = over * Eigen::Matrix<double, kSeen, kSeen>::Identity();
  return z;
}

ArmConstants constants_of(const Wanted& x, const Eigen::Matrix<double, kWanted, kWanted>& cov,
                          const Eigen::Vector3d& down_B, int motors) {
  const auto estimate = [&](int i) { return Estimate{x[i], kNormal95 * std::sqrt(cov(i, i))}; };
  ArmConstants found;
  found.mass = estimate(0);
  found.gain.fill({1, 0});  // of motors that the arm does not have
  for (int i = 0; i < motors; ++i) found.gain[static_cast<std::size_t>(i)] = estimate(1 + i);
  found.viscous = estimate(4);
  found.coulomb = estimate(5);
  const Eigen::Matrix3d weight = cov.bottomRightCorner<3, 3>();
  found.weight = {x.tail<3>().dot(down_B), kNormal95 * std::sqrt(down_B.dot(weight * down_B))};
  return found;
}

/// With the gains' geometric mean assumed to be 1, the accelerations give the mass.
ArmConstants by_declared_torque(const MassNormalisedFit& bare, const Eigen::Vector3d& down_B) {
  const Seen z = bare.theta.head<kSeen>();
  double log_gain = 0;
  for (int i = 0; i < bare.motors; ++i) log_gain += math::log(std::abs(z[i])) / bare.motors;
  Wanted x;
  x[0] = math::exp(-log_gain);
  x.tail<kSeen>() = x[0] * z;
  Eigen::Matrix<double, kWanted, kSeen> slope = Eigen::Matrix<double, kWanted, kSeen>::Zero();
  for (int i = 0; i < bare.motors; ++i) slope(0, i) = -x[0] / (bare.motors * z[i]);
  slope.bottomRows<kSeen>() = z * slope.row(0);
  slope.bottomRows<kSeen>() += x[0] * Eigen::Matrix<double, kSeen, kSeen>::Identity();
  return constants_of(x, slope * bare.covariance.topLeftCorner<kSeen, kSeen>() * slope.transpose(),
                      down_B, bare.motors);
}

}  // namespace

void widen(Estimate& estimate, double method) {
  estimate.plus_minus = math::hypot(estimate.plus_minus, kNormal95 * method);
}

Estimate by_gain(const Estimate& torque, const Estimate& gain) {
  return {torque.value * gain.value,
          math::hypot(torque.plus_minus * gain.value, torque.value * gain.plus_minus)};
}

driver::Result<ArmConstants> arm_constants(const MassNormalisedFit& bare,
                                           const Eigen::Vector3d& down_B,
                                           const std::optional<MassNormalisedFit>& loaded,
                                           double added_mass) {
  for (int i = 0; i < bare.motors; ++i) {
    if (bare.theta[i] > 0) continue;
    return driver::Error{"Joint " + std::to_string(i + 1) +
                         " does not follow its motor: something else moved it, such as a hand. Let "
                         "go of the grip and run `thimble feel-check`."};
  }
  ArmConstants found = by_declared_torque(bare, down_B);
  found.delay = bare.delay;
  if (!loaded) return found;
  Wanted x;
  double ratio = 0;  // of accelerations, bare over loaded
  for (int i = 0; i < bare.motors; ++i) ratio += bare.theta[i] / loaded->theta[i] / bare.motors;
  if (!(ratio > 1.02)) {
    return driver::Error{
        "The known mass did not slow the tip down. Fix it to the tip, or use a heavier one (about "
        "as heavy as the tip itself)."};
  }
  x[0] = added_mass / (ratio - 1);
  x.tail<kSeen>() = x[0] * bare.theta.head<kSeen>();
  Eigen::Matrix<double, kWanted, kWanted> normal;
  double square = 0;
  for (int round = 0; round < 20; ++round) {
    normal.setZero();
    Wanted right = Wanted::Zero();
    square = 0;
    const auto add = [&](const MassNormalisedFit& fit, double added) {
      Slope slope;
      const Seen rest = fit.theta.head<kSeen>() - shown(x, added, down_B, slope);
      Eigen::Matrix<double, kSeen, kSeen> covariance = fit.covariance.topLeftCorner<kSeen, kSeen>();
      // What the arm does not have was not fitted: it is 0 on both sides, with any weight.
      for (int k = 0; k < kSeen; ++k) {
        if (covariance(k, k) == 0) covariance(k, k) = 1;
      }
      const auto weight = covariance.ldlt();
      normal += slope.transpose() * weight.solve(slope);
      const Seen weighed = weight.solve(rest);
      right += slope.transpose() * weighed;
      square += rest.dot(weighed);
    };
    add(bare, 0);
    add(*loaded, added_mass);
    x += normal.ldlt().solve(right);
  }
  if (!(x[0] > 0)) return driver::Error{"The two motions do not fit an arm with positive mass."};
  const Eigen::Matrix<double, kWanted, kWanted> cov =
      normal.ldlt().solve(Eigen::Matrix<double, kWanted, kWanted>::Identity());
  found = constants_of(x, cov, down_B, bare.motors);
  found.absolute = true;
  found.misfit = square / (2 * kSeen - kWanted);
  // Both measured the same delay.
  const double first = 1 / (bare.delay.plus_minus * bare.delay.plus_minus);
  const double second = 1 / (loaded->delay.plus_minus * loaded->delay.plus_minus);
  found.delay = {(first * bare.delay.value + second * loaded->delay.value) / (first + second),
                 1 / std::sqrt(first + second)};
  return found;
}

}  // namespace thimble::bringup
