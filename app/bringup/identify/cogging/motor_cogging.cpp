#include "bringup/identify/cogging/motor_cogging.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "bringup/identify/arm_constants.h"
#include "bringup/identify/cogging/cogging_rows.h"
#include "bringup/identify/cogging/cogging_search.h"
#include "bringup/identify/delayed_tick.h"
#include "bringup/identify/weak_form/clustered_fit.h"
#include "math/elementary.h"

namespace thimble::bringup {
namespace {

// Wald's statistic of a wave's two factors required for acceptance [chosen: no arm without waves of
// identify_cogging_test is reported to have some].
constexpr double kCoggingSignificant = 60;
// Error due to quantised angles and held torques beyond the statistics, of an amplitude and, in
// rad, of a phase [chosen: so that intervals hold 95 % of the truths, identify_cogging_test].
constexpr double kCoggingMethod = 0.004;
constexpr int kCoggingRounds = 3;  // of Newton's search

constexpr Eigen::Index kVariationsOfArm = 6;  // cogging and ripple of each joint

TorqueVariation& variation_of(MotorCogging& waves, Eigen::Index wave) {
  return (wave % 2 == 0 ? waves.cogging : waves.ripple)[static_cast<std::size_t>(wave / 2)];
}

/// Factors of sine and cosine of each wave, as in CoggingRows.
using CoggingFactors = Eigen::Matrix<double, CoggingRows::kCount, 1>;

/// Sets amplitude and phase from factors and their covariance.
void put_variation(TorqueVariation& wave, bool cogging, const Eigen::Vector2d& factors,
                   const Eigen::Matrix2d& covariance) {
  // Cogging pulls back.
  const Eigen::Vector2d along = (cogging ? -factors : factors);
  const double amplitude = along.norm();
  const Eigen::Vector2d unit = along / amplitude, across(-unit[1], unit[0]);
  wave.amplitude = {amplitude, kNormal95 * math::hypot(std::sqrt(unit.dot(covariance * unit)),
                                                       kCoggingMethod * amplitude)};
  wave.phase = {math::atan2(along[1], along[0]),
                kNormal95 * math::hypot(std::sqrt(across.dot(covariance * across)) / amplitude,
                                        kCoggingMethod)};
}

class CoggingSearch {
 public:
  CoggingSearch(const ArmMotion& motion, const CoggingPeriods& periods,
                const Eigen::Vector3d& ratio, double delay)
      : motion_(motion) {
    found_.searched = periods.best > 0;
    found_.not_done = found_.searched ? "" : "not identified; the motors did not turn far enough.";
    found_.min_periods = periods.min_periods;
    found_.max_periods = periods.max_periods;
    found_.periods = periods.best;
    found_.rivals = periods.rivals;
    found_.ratio = ratio;
    found_.delay = delay;
  }

  driver::Result<MotorCogging> find(const FittedMotion& first) {
    if (!found_.searched) return found_;
    select_significant(first);
    const double square = first.residual.rest.squaredNorm();
    for (int round = 0; round < kCoggingRounds && found_.seen(); ++round) {
      const ArmMotion cleaned = without_cogging(motion_, found_);
      const auto fit = fit_motion(cleaned, false);
      if (!fit) return fit.error();
      found_.delay = fit->delay.value;
      const FittedMotion motion(cleaned, *fit);
      found_.left = motion.residual.rest.squaredNorm() / square;
      refine(motion);
      if (round + 1 == kCoggingRounds) bounds(motion);
    }
    if (!found_.seen()) bounds(first);
    return found_;
  }

 private:
  /// Selects the significant waves by removing the weakest one repeatedly.
  void select_significant(const FittedMotion& motion) {
    const CoggingRows rows(motion, found_.ratio);
    const Eigen::MatrixXd columns = rows.columns(found_.periods);
    const Eigen::Vector3d turned = rows.turned(found_.periods);
    for (Eigen::Index wave = 0; wave < kVariationsOfArm; ++wave) {
      variation_of(found_, wave).seen = turned[wave / 2] >= kPeriodsTurnedOnceKnown;
    }
    while (found_.seen()) {
      const FurtherColumns fit = further(motion, columns);
      double weakest = HUGE_VAL;
      Eigen::Index weakest_wave = 0, k = 0;
      for (Eigen::Index wave = 0; wave < kVariationsOfArm; ++wave) {
        TorqueVariation& one = variation_of(found_, wave);
        if (!one.seen) continue;
        const Eigen::Vector2d factors = fit.factor.segment<2>(k);
        const Eigen::Matrix2d covariance = fit.covariance.block<2, 2>(k, k);
        k += 2;
        const double wald = factors.dot(covariance.inverse() * factors);
        if (wald < weakest) weakest = wald, weakest_wave = wave;
      }
      if (weakest > kCoggingSignificant) {
        take(fit);
        return;
      }
      variation_of(found_, weakest_wave).seen = false;
    }
  }

  /// Computes the detection limits of waves.
  void bounds(const FittedMotion& motion) {
    bound(motion, found_.min_periods);
    if (found_.min_periods == found_.max_periods) return;
    for (double periods = kFewPeriods; periods < found_.max_periods; periods *= 4)
      bound(motion, periods);
    bound(motion, found_.max_periods);
  }

  void bound(const FittedMotion& motion, double periods) {
    const CoggingRows rows(motion, found_.ratio);
    const Eigen::Vector3d turned = rows.turned(periods);
    const FurtherColumns fit = fit_further(motion.residual.rows, motion.residual.rest,
                                           rows.columns(periods), motion.residual.clusters);
    for (Eigen::Index wave = 0; wave < kVariationsOfArm; ++wave) {
      if (turned[wave / 2] < kPeriodsTurned) continue;
      const double widest = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(
                                fit.covariance.block<2, 2>(2 * wave, 2 * wave))
                                .eigenvalues()[1];
      const double seen = (std::sqrt(kCoggingSignificant) + kNormal95) * std::sqrt(widest);
      TorqueVariation& one = variation_of(found_, wave);
      if (periods <= kFewPeriods) one.below = std::max(one.below, seen);
      one.below_of_any = std::max(one.below_of_any, seen);
    }
  }

  void refine(const FittedMotion& motion) {
    take(further(motion, CoggingRows(motion, found_.ratio).columns(found_.periods)));
  }

  FurtherColumns further(const FittedMotion& motion, const Eigen::MatrixXd& columns) {
    Eigen::MatrixXd accepted(columns.rows(), 0);
    for (Eigen::Index wave = 0; wave < kVariationsOfArm; ++wave) {
      if (!variation_of(found_, wave).seen) continue;
      accepted.conservativeResize(Eigen::NoChange, accepted.cols() + 2);
      accepted.rightCols<2>() = columns.middleCols<2>(2 * wave);
    }
    return fit_further(motion.residual.rows, motion.residual.rest, accepted,
                       motion.residual.clusters);
  }

  /// Adds the result of a fit to the waves already removed from the motion.
  void take(const FurtherColumns& fit) {
    Eigen::Index k = 0;
    for (Eigen::Index wave = 0; wave < kVariationsOfArm; ++wave) {
      TorqueVariation& one = variation_of(found_, wave);
      if (!one.seen) continue;
      factors_.segment<2>(2 * wave) += fit.factor.segment<2>(k);
      put_variation(one, wave % 2 == 0, factors_.segment<2>(2 * wave),
                    fit.covariance.block<2, 2>(k, k));
      k += 2;
    }
  }

  const ArmMotion& motion_;
  MotorCogging found_;
  CoggingFactors factors_ = CoggingFactors::Zero();
};

}  // namespace

bool MotorCogging::seen() const {
  const auto is_seen = [](const TorqueVariation& one) { return one.seen; };
  return std::any_of(cogging.begin(), cogging.end(), is_seen) ||
         std::any_of(ripple.begin(), ripple.end(), is_seen);
}

Estimate cogging_at_motor(const MotorCogging& waves, std::size_t motor, const Estimate& gain) {
  const TorqueVariation& wave = waves.cogging[motor];
  if (!waves.is_reported() || !wave.seen) return {};
  const Estimate at_joint = by_gain(wave.amplitude, gain);
  const double ratio = waves.ratio[static_cast<Eigen::Index>(motor)];
  return {at_joint.value / ratio, at_joint.plus_minus / ratio};
}

ArmMotion without_cogging(const ArmMotion& motion, const MotorCogging& waves) {
  ArmMotion cleaned = motion;
  if (!waves.seen()) return cleaned;
  const DelayedTick acting(waves.delay, motion.dt);
  for (std::size_t k = 0; k + acting.whole + 1 < cleaned.samples.size(); ++k) {
    const Eigen::Vector3d q = acting.then(k, [&](std::size_t at) { return motion.samples[at].q; });
    for (int joint = 0; joint < 3; ++joint) {
      const auto i = static_cast<std::size_t>(joint);
      const TorqueVariation &cogging = waves.cogging[i], &ripple = waves.ripple[i];
      const double angle = waves.periods * waves.ratio[joint] * q[joint];
      double& tau = cleaned.samples[k].tau[joint];
      if (ripple.seen) tau += tau * ripple.amplitude.value * math::sin(angle + ripple.phase.value);
      if (cogging.seen) tau -= cogging.amplitude.value * math::sin(angle + cogging.phase.value);
    }
  }
  return cleaned;
}

driver::Result<MotorCogging> find_cogging(const ArmMotion& motion, const MassNormalisedFit& held,
                                          const Eigen::Vector3d& ratio, double named) {
  const FittedMotion fitted(motion, held);
  const CoggingPeriods periods = find_periods(fitted, CoggingRows(fitted, ratio), named);
  return CoggingSearch(motion, periods, ratio, held.delay.value).find(fitted);
}

}  // namespace thimble::bringup
