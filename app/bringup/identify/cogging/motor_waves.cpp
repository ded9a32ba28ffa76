#include "bringup/identify/cogging/motor_waves.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "bringup/identify/acting_tick.h"
#include "bringup/identify/arm_constants.h"
#include "bringup/identify/cogging/wave_rows.h"
#include "bringup/identify/cogging/wave_search.h"
#include "bringup/identify/weak_form/clustered_fit.h"
#include "math/elementary.h"

namespace thimble::bringup {
namespace {

// Wald's statistic of a wave's two factors required for acceptance [chosen: no arm without waves of
// identify_waves_test is reported to have some].
constexpr double kWaveBelieved = 60;
// Error due to quantised angles and held torques beyond the statistics, of an amplitude and, in
// rad, of a phase [chosen: so that intervals hold 95 % of the truths, identify_waves_test].
constexpr double kWaveMethod = 0.004;
constexpr int kWaveRounds = 3;  // of Newton's search

constexpr Eigen::Index kWavesOfArm = 6;  // cogging and ripple of each joint

MotorWave& wave_of(MotorWaves& waves, Eigen::Index wave) {
  return (wave % 2 == 0 ? waves.cogging : waves.ripple)[static_cast<std::size_t>(wave / 2)];
}

/// Factors of sine and cosine of each wave, as in WaveRows.
using WaveFactors = Eigen::Matrix<double, WaveRows::kCount, 1>;

/// Sets amplitude and phase from factors and their covariance.
void put_wave(MotorWave& wave, bool cogging, const Eigen::Vector2d& factors,
              const Eigen::Matrix2d& covariance) {
  // Cogging pulls back.
  const Eigen::Vector2d along = (cogging ? -factors : factors);
  const double amplitude = along.norm();
  const Eigen::Vector2d unit = along / amplitude, across(-unit[1], unit[0]);
  wave.amplitude = {amplitude, kNormal95 * math::hypot(std::sqrt(unit.dot(covariance * unit)),
                                                       kWaveMethod * amplitude)};
  wave.phase = {
      math::atan2(along[1], along[0]),
      kNormal95 * math::hypot(std::sqrt(across.dot(covariance * across)) / amplitude, kWaveMethod)};
}

class WavesOfMotion {
 public:
  WavesOfMotion(const ArmMotion& motion, const WavePeriods& periods, const Eigen::Vector3d& ratio,
                double delay)
      : motion_(motion) {
    found_.searched = periods.best > 0;
    found_.not_done = found_.searched ? "" : "not identified; the motors did not turn far enough.";
    found_.least = periods.least;
    found_.most = periods.most;
    found_.periods = periods.best;
    found_.rivals = periods.rivals;
    found_.ratio = ratio;
    found_.delay = delay;
  }

  driver::Result<MotorWaves> find(const FittedMotion& first) {
    if (!found_.searched) return found_;
    believe(first);
    const double square = first.residual.rest.squaredNorm();
    for (int round = 0; round < kWaveRounds && found_.seen(); ++round) {
      const ArmMotion freed = freed_of_waves(motion_, found_);
      const auto fit = fit_motion(freed, false);
      if (!fit) return fit.error();
      found_.delay = fit->delay.value;
      const FittedMotion motion(freed, *fit);
      found_.left = motion.residual.rest.squaredNorm() / square;
      refine(motion);
      if (round + 1 == kWaveRounds) bounds(motion);
    }
    if (!found_.seen()) bounds(first);
    return found_;
  }

 private:
  /// Selects the significant waves by removing the weakest one repeatedly.
  void believe(const FittedMotion& motion) {
    const WaveRows rows(motion, found_.ratio);
    const Eigen::MatrixXd columns = rows.columns(found_.periods);
    const Eigen::Vector3d turned = rows.turned(found_.periods);
    for (Eigen::Index wave = 0; wave < kWavesOfArm; ++wave) {
      wave_of(found_, wave).seen = turned[wave / 2] >= kPeriodsTurnedOnceKnown;
    }
    while (found_.seen()) {
      const FurtherColumns fit = further(motion, columns);
      double weakest = HUGE_VAL;
      Eigen::Index least = 0, k = 0;
      for (Eigen::Index wave = 0; wave < kWavesOfArm; ++wave) {
        MotorWave& one = wave_of(found_, wave);
        if (!one.seen) continue;
        const Eigen::Vector2d factors = fit.factor.segment<2>(k);
        const Eigen::Matrix2d covariance = fit.covariance.block<2, 2>(k, k);
        k += 2;
        const double wald = factors.dot(covariance.inverse() * factors);
        if (wald < weakest) weakest = wald, least = wave;
      }
      if (weakest > kWaveBelieved) {
        take(fit);
        return;
      }
      wave_of(found_, least).seen = false;
    }
  }

  /// Computes the detection limits of waves.
  void bounds(const FittedMotion& motion) {
    bound(motion, found_.least);
    if (found_.least == found_.most) return;
    for (double periods = kFewPeriods; periods < found_.most; periods *= 4) bound(motion, periods);
    bound(motion, found_.most);
  }

  void bound(const FittedMotion& motion, double periods) {
    const WaveRows rows(motion, found_.ratio);
    const Eigen::Vector3d turned = rows.turned(periods);
    const FurtherColumns fit = fit_further(motion.residual.rows, motion.residual.rest,
                                           rows.columns(periods), motion.residual.clusters);
    for (Eigen::Index wave = 0; wave < kWavesOfArm; ++wave) {
      if (turned[wave / 2] < kPeriodsTurned) continue;
      const double widest = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(
                                fit.covariance.block<2, 2>(2 * wave, 2 * wave))
                                .eigenvalues()[1];
      const double seen = (std::sqrt(kWaveBelieved) + kNormal95) * std::sqrt(widest);
      MotorWave& one = wave_of(found_, wave);
      if (periods <= kFewPeriods) one.below = std::max(one.below, seen);
      one.below_of_any = std::max(one.below_of_any, seen);
    }
  }

  void refine(const FittedMotion& motion) {
    take(further(motion, WaveRows(motion, found_.ratio).columns(found_.periods)));
  }

  FurtherColumns further(const FittedMotion& motion, const Eigen::MatrixXd& columns) {
    Eigen::MatrixXd believed(columns.rows(), 0);
    for (Eigen::Index wave = 0; wave < kWavesOfArm; ++wave) {
      if (!wave_of(found_, wave).seen) continue;
      believed.conservativeResize(Eigen::NoChange, believed.cols() + 2);
      believed.rightCols<2>() = columns.middleCols<2>(2 * wave);
    }
    return fit_further(motion.residual.rows, motion.residual.rest, believed,
                       motion.residual.clusters);
  }

  /// Adds the result of a fit to the waves already removed from the motion.
  void take(const FurtherColumns& fit) {
    Eigen::Index k = 0;
    for (Eigen::Index wave = 0; wave < kWavesOfArm; ++wave) {
      MotorWave& one = wave_of(found_, wave);
      if (!one.seen) continue;
      factors_.segment<2>(2 * wave) += fit.factor.segment<2>(k);
      put_wave(one, wave % 2 == 0, factors_.segment<2>(2 * wave), fit.covariance.block<2, 2>(k, k));
      k += 2;
    }
  }

  const ArmMotion& motion_;
  MotorWaves found_;
  WaveFactors factors_ = WaveFactors::Zero();
};

}  // namespace

bool MotorWaves::seen() const {
  const auto is_seen = [](const MotorWave& one) { return one.seen; };
  return std::any_of(cogging.begin(), cogging.end(), is_seen) ||
         std::any_of(ripple.begin(), ripple.end(), is_seen);
}

Estimate cogging_at_motor(const MotorWaves& waves, std::size_t motor, const Estimate& gain) {
  const MotorWave& wave = waves.cogging[motor];
  if (!waves.told() || !wave.seen) return {};
  const Estimate at_joint = by_gain(wave.amplitude, gain);
  const double ratio = waves.ratio[static_cast<Eigen::Index>(motor)];
  return {at_joint.value / ratio, at_joint.plus_minus / ratio};
}

ArmMotion freed_of_waves(const ArmMotion& motion, const MotorWaves& waves) {
  ArmMotion freed = motion;
  if (!waves.seen()) return freed;
  const ActingTick acting(waves.delay, motion.dt);
  for (std::size_t k = 0; k + acting.whole + 1 < freed.samples.size(); ++k) {
    const Eigen::Vector3d q = acting.then(k, [&](std::size_t at) { return motion.samples[at].q; });
    for (int joint = 0; joint < 3; ++joint) {
      const auto i = static_cast<std::size_t>(joint);
      const MotorWave &cogging = waves.cogging[i], &ripple = waves.ripple[i];
      const double angle = waves.periods * waves.ratio[joint] * q[joint];
      double& tau = freed.samples[k].tau[joint];
      if (ripple.seen) tau += tau * ripple.amplitude.value * math::sin(angle + ripple.phase.value);
      if (cogging.seen) tau -= cogging.amplitude.value * math::sin(angle + cogging.phase.value);
    }
  }
  return freed;
}

driver::Result<MotorWaves> find_waves(const ArmMotion& motion, const PerMass& held,
                                      const Eigen::Vector3d& ratio, double named) {
  const FittedMotion fitted(motion, held);
  const WavePeriods periods = find_periods(fitted, WaveRows(fitted, ratio), named);
  return WavesOfMotion(motion, periods, ratio, held.delay.value).find(fitted);
}

}  // namespace thimble::bringup
