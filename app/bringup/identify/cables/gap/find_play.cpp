#include "bringup/identify/cables/gap/find_play.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "math/elementary.h"

namespace thimble::app {
namespace {

using Gap = GapTheta;

// Pieces of motion, ticks of each: short ones for the search, in which a wrong start does little,
// long ones for the constants, which slow motion shows.
constexpr std::size_t kShortPieces = 60, kShort = 40, kMiddle = 60, kLongPieces = 50, kLong = 80;
constexpr double kFitsNearly = 1.5;  // chi^2 per degree of freedom
constexpr double kFits = 2;
// What the search costs beyond the statistics, one deviation of it [chosen: so that intervals hold
// 95 % of the truths of hidden arms, identify_play_test]: of a width, and rad.
constexpr double kMethodShare = 0.006, kMethodWidth = 3e-6;

/// Returns constants to begin with. At high frequencies a motor moves alone, whatever its play is:
/// the lines know gain over inertia. At low ones it moves with its link, as in the rigid fit. Both
/// together are gain and inertia.
Gap::Vector first_constants(const PerMass& rigid, const CableFit& lines) {
  const Eigen::Matrix<double, TwoMass::kCount, 1>& seen = lines.elastic.theta;
  Gap::Vector theta = Gap::Vector::Zero();
  for (int i = 0; i < 3; ++i) {
    const double fast = seen[TwoMass::kGain + i] / seen[TwoMass::kInertia + i];
    const double slow = rigid.theta[PerMass::kGain + i];
    const double inertia = slow / std::max(0.05 * fast, fast - slow / lines.JTJ(i, i));
    const double stiffness = 1 / seen[TwoMass::kCompliance + i];
    theta[Gap::kGain + i] = fast * inertia;
    theta[Gap::kInertia + i] = inertia;
    theta[Gap::kStiffness + i] = stiffness;
    theta[Gap::kDamping + i] = stiffness * std::max(1e-5, seen[TwoMass::kFade + i]);
    theta[Gap::kWeight + i] = rigid.theta[PerMass::kWeight + i];
  }
  theta[Gap::kDelay] = seen[TwoMass::kDelay];
  theta[Gap::kViscous] = std::max(0.0, rigid.theta[PerMass::kViscous]);
  theta[Gap::kCoulomb] = std::max(0.0, rigid.theta[PerMass::kCoulomb]);
  return theta;
}

/// Searches for play from several widths.
GapFit search_play(const ArmMotion& motion, const Gap::Vector& start, const GapFit& without) {
  const GapPieces pieces(motion, kShortPieces, kShort);
  Gap::Vector from = without.theta;
  if (without.misfit < kFitsNearly) {
    from.tail<3>() = motion.step;
    return fit_gap(pieces, from, true, 20);
  }
  // In steps of the encoders: what is below one is not seen, and what is far above 15 is no cable.
  constexpr double kWidths[] = {2, 5, 13};
  constexpr double kStiffer = 2;  // than with the play in it
  const GapPieces few(motion, 24, kShort);
  GapFit best;
  best.misfit = HUGE_VAL;
  for (const double width : kWidths) {
    from = start;
    from.segment<3>(Gap::kStiffness) *= kStiffer;
    from.tail<3>() = width * motion.step;
    GapFit one = fit_gap(few, from, true, 5);
    if (one.misfit < best.misfit) best = one;
  }
  best = fit_gap(pieces, best.theta, true, 25);
  // Where one joint is caught in another valley: elsewhere with it.
  for (int sweep = 0; sweep < 2; ++sweep) {
    for (int joint = 0; joint < 3; ++joint) {
      for (const double wider : {0.4, 2.5}) {
        if (best.misfit < kFitsNearly) return best;
        from = best.theta;
        from[Gap::kPlay + joint] = wider * std::max(from[Gap::kPlay + joint], motion.step[joint]);
        const GapFit other = fit_gap(few, from, true, 6);
        const GapFit more = fit_gap(pieces, other.theta, true, 6);
        if (more.misfit < best.misfit) best = more;
      }
    }
  }
  return best;
}

}  // namespace

PlayFit find_play(const ArmMotion& motion, const PerMass& rigid, const CableFit& lines) {
  PlayFit found;
  found.searched = true;
  const Gap::Vector start = first_constants(rigid, lines);
  const GapPieces brief(motion, kShortPieces, kShort), whole(motion, kLongPieces, kLong);
  const GapFit without = fit_gap(brief, start, false, 15);
  const GapFit with = search_play(motion, start, without);
  found.without = fit_gap(whole, without.theta, false, 10);
  const GapFit closer = fit_gap(GapPieces(motion, kLongPieces, kMiddle), with.theta, true, 15);
  found.with = fit_gap(whole, closer.theta, true, 20);
  const double misfit = std::max(1.0, found.with.misfit);
  found.better =
      (found.without.chi2 / found.without.samples - found.with.chi2 / found.with.samples) *
          found.with.samples / misfit -
      3 * math::log(found.with.samples);
  found.fits = std::min(found.without.misfit, found.with.misfit) < kFits && found.with.lost < 0.25;
  constexpr double kBetter = 20;
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double error = std::sqrt(found.with.covariance(Gap::kPlay + i, Gap::kPlay + i));
    const double width = found.with.theta[Gap::kPlay + i];
    const double method = math::hypot(kMethodShare * width, kMethodWidth);
    found.width[k] = {width, kNormal95 * math::hypot(error, method)};
    found.shows[k] = width > 5 * math::hypot(error, kMethodWidth);
  }
  found.like_play = !found.fits && found.with.misfit < 0.5 * found.without.misfit;
  found.seen = found.fits && found.with.misfit < kFits && found.better > kBetter &&
               std::any_of(found.shows.begin(), found.shows.end(), [](bool one) { return one; });
  return found;
}

GapFit fit_play_again(const ArmMotion& motion, const PerMass& rigid, const PerMass& rigid_bare,
                      const GapFit& bare) {
  double scale = 1;
  for (int i = 0; i < 3; ++i) {
    scale *= rigid.theta[PerMass::kGain + i] / rigid_bare.theta[PerMass::kGain + i];
  }
  scale = math::pow(scale, 1.0 / 3);
  Gap::Vector from = bare.theta;
  from.segment<3>(Gap::kGain) *= scale;
  from.segment<2>(Gap::kViscous) *= scale;
  from.segment<9>(Gap::kInertia) *= scale;
  from.segment<3>(Gap::kWeight) = rigid.theta.segment<3>(PerMass::kWeight);
  const GapFit close = fit_gap(GapPieces(motion, kShortPieces, kShort), from, true, 20);
  return fit_gap(GapPieces(motion, kLongPieces, kLong), close.theta, true, 20);
}

PerMass per_mass_of(const GapFit& fit, const ArmMotion& motion) {
  constexpr std::pair<int, int> kSame[] = {{PerMass::kGain, Gap::kGain},
                                           {PerMass::kGain + 1, Gap::kGain + 1},
                                           {PerMass::kGain + 2, Gap::kGain + 2},
                                           {PerMass::kViscous, Gap::kViscous},
                                           {PerMass::kCoulomb, Gap::kCoulomb},
                                           {PerMass::kWeight, Gap::kWeight},
                                           {PerMass::kWeight + 1, Gap::kWeight + 1},
                                           {PerMass::kWeight + 2, Gap::kWeight + 2},
                                           {PerMass::kStiffness, Gap::kSpring}};
  PerMass found;
  for (const auto& [to, from] : kSame) {
    found.theta[to] = fit.theta[from];
    for (const auto& [other_to, other_from] : kSame) {
      found.covariance(to, other_to) = fit.covariance(from, other_from);
    }
  }
  found.delay = {fit.theta[Gap::kDelay],
                 kNormal95 * std::sqrt(fit.covariance(Gap::kDelay, Gap::kDelay))};
  found.windows = static_cast<std::size_t>(fit.samples) / (3 * kLong);
  found.left_out = static_cast<std::size_t>(fit.lost * static_cast<double>(found.windows));
  // Of the angles, for a fit of which no accelerations are known.
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
  Eigen::Matrix<double, TwoMass::kCount, Gap::kCount> slope;
  slope.setZero();
  const auto take = [&](int to, int from) {
    found.theta[to] = fit.theta[from];
    slope(to, from) = 1;
  };
  take(TwoMass::kDelay, Gap::kDelay);
  take(TwoMass::kViscous, Gap::kViscous);
  for (int i = 0; i < 3; ++i) {
    take(TwoMass::kGain + i, Gap::kGain + i);
    take(TwoMass::kInertia + i, Gap::kInertia + i);
    found.theta[TwoMass::kRotorViscous + i] = 0;
    const double stiffness = fit.theta[Gap::kStiffness + i], damping = fit.theta[Gap::kDamping + i];
    found.theta[TwoMass::kCompliance + i] = 1 / stiffness;
    found.theta[TwoMass::kFade + i] = damping / stiffness;
    slope(TwoMass::kCompliance + i, Gap::kStiffness + i) = -1 / (stiffness * stiffness);
    slope(TwoMass::kFade + i, Gap::kDamping + i) = 1 / stiffness;
    slope(TwoMass::kFade + i, Gap::kStiffness + i) = -damping / (stiffness * stiffness);
  }
  found.covariance = slope * fit.covariance * slope.transpose();
  found.misfit = fit.misfit;
  return found;
}

}  // namespace thimble::app
