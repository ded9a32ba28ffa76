#include "bringup/identify/cables/backlash/find_play.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "bringup/identify/arm_constants.h"
#include "bringup/identify/cables/backlash/gap_constants.h"
#include "math/elementary.h"

namespace thimble::bringup {
namespace {

using Gap = GapTheta;

// Pieces of motion, and their ticks. Short ones are for the search, where a wrong start has little
// effect; long ones for the constants, which slow motion shows.
constexpr std::size_t kShortPieces = 60, kShort = 40, kMiddle = 60, kLongPieces = 50, kLong = 80;
constexpr double kFitsAlready = 1.1, kFitsNearly = 1.5;  // chi^2 per degree of freedom
constexpr double kFits = 2;
// Error of the search beyond the statistics, as one standard deviation [chosen: so that intervals
// hold 95 % of the truths of hidden arms, identify_play_test]: of a width, and rad.
constexpr double kMethodShare = 0.006, kMethodWidth = 3e-6;
// Likewise half-widths of intervals of the friction of motors, N m s/rad and N m. By statistics
// only, arms with wide backlash and no friction get up to 6e-5 N m [identify_joint_friction_test,
// identify_play_test].
constexpr double kMethodViscous = 5e-5, kMethodCoulomb = 3e-5;
// Max. damping of a cable over its stiffness, s: a part with more losses is not a spring [chosen:
// at 40 Hz more than 0.6 of the critical damping].
constexpr double kFadeMost = 5e-3, kFade = 3e-4;
constexpr double kPlayBetter = 20;  // information required for acceptance
constexpr double kPlayShows = 5;    // deviations required to write a number

bool is_spring(const Gap::Vector& theta, int joint) {
  return theta[Gap::kDamping + joint] < kFadeMost * theta[Gap::kStiffness + joint];
}
bool are_springs(const GapFit& fit) {
  return is_spring(fit.theta, 0) && is_spring(fit.theta, 1) && is_spring(fit.theta, 2);
}

/// Takes another fit if its residual is smaller.
void keep_better(GapFit& best, const GapFit& other) {
  if (other.misfit < best.misfit) best = other;
}

/// Leaves a local minimum for a better one. A motor that mostly stands still hides its cable, and a
/// soft one with large losses looks the same. Starts from stiffer cables with small losses.
void leave_valley(const GapPieces& whole, const GapSought& sought, GapFit& fit) {
  constexpr double kStiffer[] = {2, 6};
  for (int joint = 0; joint < 3; ++joint) {
    for (const double stiffer : kStiffer) {
      if (is_spring(fit.theta, joint)) break;
      Gap::Vector from = fit.theta;
      from[Gap::kStiffness + joint] *= stiffer;
      from[Gap::kDamping + joint] = kFade * from[Gap::kStiffness + joint];
      keep_better(fit, fit_gap(whole, from, sought, 20));
    }
  }
}

/// Searches for backlash from several widths.
GapFit search_play(const ArmMotion& motion, const Gap::Vector& start, const GapFit& without,
                   bool friction) {
  const GapSought sought{.play = true, .friction = friction};
  const GapPieces pieces(motion, kShortPieces, kShort);
  Gap::Vector from = without.theta;
  if (without.misfit < kFitsNearly) {
    from.segment<3>(Gap::kPlay) = motion.step;
    return fit_gap(pieces, from, sought, 20);
  }
  // In encoder steps: less than one is not visible, and far more than 15 is not a cable.
  constexpr double kWidths[] = {2, 5, 13};
  constexpr double kStiffer = 2;  // stiffness of a cable relative to a fit without backlash
  const GapPieces few(motion, 24, kShort);
  GapFit best;
  for (const double width : kWidths) {
    from = start;
    from.segment<3>(Gap::kStiffness) *= kStiffer;
    from.segment<3>(Gap::kPlay) = width * motion.step;
    keep_better(best, fit_gap(few, from, sought, 5));
  }
  best = fit_gap(pieces, best.theta, sought, 25);
  // One joint may be in another local minimum, so its other start values are tried.
  for (int sweep = 0; sweep < 2; ++sweep) {
    for (int joint = 0; joint < 3; ++joint) {
      for (const double wider : {0.4, 2.5}) {
        if (best.misfit < kFitsNearly) return best;
        from = best.theta;
        from[Gap::kPlay + joint] = wider * std::max(from[Gap::kPlay + joint], motion.step[joint]);
        const GapFit other = fit_gap(few, from, sought, 6);
        keep_better(best, fit_gap(pieces, other.theta, sought, 6));
      }
    }
  }
  return best;
}

/// Searches for friction of the motors, starting from the fit without it; if that does not fit,
/// from shares of a rigid arm's friction along its axes.
GapFit search_friction(const ArmMotion& motion, const GapPieces& pieces, const Gap::Vector& start,
                       const Eigen::Matrix3d& JTJ, const GapFit& without) {
  const GapSought sought{.friction = true};
  GapFit best = fit_gap(pieces, without.theta, sought, 12);
  if (best.misfit < kFitsAlready) return best;
  const GapPieces few(motion, 24, kShort);
  GapFit other;
  for (const double share : {0.3, 0.6}) {
    Gap::Vector from = start;
    from[Gap::kCoulomb] *= 1 - share;
    for (int i = 0; i < 3; ++i) {
      from[Gap::kRotorCoulomb + i] = share * start[Gap::kCoulomb] * std::sqrt(JTJ(i, i));
    }
    keep_better(other, fit_gap(few, from, sought, 8));
  }
  keep_better(best, fit_gap(pieces, other.theta, sought, 15));
  return best;
}

/// Returns the gain of the Bayesian information criterion by a fit with `count` more constants.
double better_by(const GapFit& without, const GapFit& with, int count) {
  const double misfit = std::max(1.0, with.misfit);
  return (without.chi2 / without.samples - with.chi2 / with.samples) * with.samples / misfit -
         count * math::log(with.samples);
}

/// Judges the fits without and with backlash.
void judge_play(PlayFit& found) {
  found.better = better_by(found.without, found.with, 3);
  found.fits = std::min(found.without.misfit, found.with.misfit) < kFits && found.with.lost < 0.25;
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double error = std::sqrt(found.with.covariance(Gap::kPlay + i, Gap::kPlay + i));
    const double width = found.with.theta[Gap::kPlay + i];
    const double method = math::hypot(kMethodShare * width, kMethodWidth);
    found.width[k] = {width, kNormal95 * math::hypot(error, method)};
    found.shows[k] = width > kPlayShows * math::hypot(error, kMethodWidth);
  }
  found.like_play = !found.fits && found.with.misfit < 0.5 * found.without.misfit;
  found.seen = found.fits && found.with.misfit < kFits && found.better > kPlayBetter &&
               std::any_of(found.shows.begin(), found.shows.end(), [](bool one) { return one; });
}

/// Returns one constant over the gain of its motor; the interval includes their correlation.
Estimate over_gain(const GapFit& fit, int k, int joint) {
  const int g = Gap::kGain + joint;
  const double gain = fit.theta[g], ratio = fit.theta[k] / gain;
  const double variance = fit.covariance(k, k) - 2 * ratio * fit.covariance(k, g) +
                          ratio * ratio * fit.covariance(g, g);
  return {ratio, kNormal95 * std::sqrt(std::max(0.0, variance)) / gain};
}

/// Judges a fit with friction of the motors, compared with the same fit without it.
RotorFriction judge_friction(const GapFit& without, const GapFit& with) {
  RotorFriction found;
  found.better = better_by(without, with, 6);
  bool any = false;
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const auto take = [&](int from, double method, Estimate& to, bool& shows) {
      to = over_gain(with, from + i, i);
      widen(to, method);
      shows = to.value > kPlayShows / kNormal95 * to.plus_minus;
      any = any || shows;
    };
    take(Gap::kRotorViscous, kMethodViscous, found.viscous[k], found.shows_viscous[k]);
    take(Gap::kRotorCoulomb, kMethodCoulomb, found.coulomb[k], found.shows_coulomb[k]);
  }
  // A search that ended in another local minimum leaves a somewhat larger residual, and friction
  // that is far off.
  found.fits = with.misfit < kFitsAlready && are_springs(with);
  found.seen = any && found.fits && found.better > kPlayBetter;
  return found;
}

/// Searches for friction of the motors in addition to the fit without it.
void look_for_friction(const GapPieces& whole, PlayFit& found) {
  PlayFit both = found;
  GapFit& best = found.seen ? both.with : both.without;
  best = fit_gap(whole, best.theta, {.play = found.seen, .friction = true}, 15);
  leave_valley(whole, {.play = found.seen, .friction = true}, best);
  if (!found.fits) {
    // A motion that did not fit without friction may have backlash, or only friction.
    both.with = fit_gap(whole, found.with.theta, {.play = true, .friction = true}, 20);
  }
  judge_play(both);
  both.friction = judge_friction(both.seen ? found.with : found.without, both.best());
  found.friction = both.friction;
  if (both.friction.seen) found = both;
}

/// Returns constants that explain a motion without backlash and friction of motors, with springs
/// softer than in `start` and with smaller losses. Lines mislead if a link oscillates below the
/// lowest of them. Empty if there are none: a motor that mostly stands still shows too little for
/// that.
std::optional<Gap::Vector> softer_start(const ArmMotion& motion, const Gap::Vector& start) {
  constexpr double kSofter[] = {0.5, 0.25, 0.125};  // than the lines show
  const GapPieces few(motion, 24, kShort);
  GapFit best;
  for (const double share : kSofter) {
    Gap::Vector from = start;
    from.segment<3>(Gap::kStiffness) *= share;
    from.segment<3>(Gap::kDamping) = kFade * from.segment<3>(Gap::kStiffness);
    keep_better(best, fit_gap(few, from, {}, 12));
  }
  best = fit_gap(GapPieces(motion, kShortPieces, kShort), best.theta, {}, 15);
  if (!(best.misfit < kFitsNearly)) return {};
  best = fit_gap(GapPieces(motion, kLongPieces, kLong), best.theta, {}, 15);
  if (!(best.misfit < kFitsAlready)) return {};
  return best.theta;
}

/// Searches for backlash and friction of the motors from constants without either.
PlayFit find_play_from(const ArmMotion& motion, const Gap::Vector& start,
                       const Eigen::Matrix3d& JTJ) {
  PlayFit found;
  found.searched = true;
  const GapPieces brief(motion, kShortPieces, kShort), whole(motion, kLongPieces, kLong);
  const GapFit plain = fit_gap(brief, start, {}, 15);
  // If only friction of the motors is missing, backlash is searched for in addition to it.
  const GapFit rubbed = search_friction(motion, brief, start, JTJ, plain);
  const bool rubs = rubbed.misfit < kFitsNearly && better_by(plain, rubbed, 6) > kPlayBetter;
  const GapFit& without = rubs ? rubbed : plain;
  const GapFit with = search_play(motion, start, without, rubs);
  const GapSought sought{.play = true, .friction = rubs};
  const GapPieces middle(motion, kLongPieces, kMiddle);
  if (rubs) {
    const GapFit near = fit_gap(middle, without.theta, {.friction = true}, 15);
    found.without = fit_gap(whole, near.theta, {.friction = true}, 20);
    leave_valley(whole, {.friction = true}, found.without);
  } else {
    found.without = fit_gap(whole, without.theta, {}, 10);
  }
  const GapFit closer = fit_gap(middle, with.theta, sought, 15);
  found.with = fit_gap(whole, closer.theta, sought, 20);
  if (rubs) leave_valley(whole, sought, found.with);
  judge_play(found);
  found.plain = found.without;
  if (!rubs) {
    look_for_friction(whole, found);
    return found;
  }
  if (!found.seen && found.with.misfit < found.without.misfit) {
    // Backlash too small to be seen improves nothing; then the cause is another local minimum.
    Gap::Vector tight = found.with.theta;
    tight.segment<3>(Gap::kPlay).setZero();
    keep_better(found.without, fit_gap(whole, tight, {.friction = true}, 20));
    judge_play(found);
  }
  Gap::Vector smooth = found.best().theta;
  smooth.tail<6>().setZero();
  const GapFit other = fit_gap(whole, smooth, {.play = found.seen}, 10);
  found.friction = judge_friction(other, found.best());
  found.plain = found.seen ? fit_gap(whole, plain.theta, {}, 10) : other;
  return found;
}

}  // namespace

bool PlayFit::understood() const {
  return told() || (searched && fits && best().misfit < kFitsAlready && are_springs(best()));
}

PlayFit find_play(const ArmMotion& motion, const PerMass& rigid, const CableFit& lines) {
  const Gap::Vector start = gap_constants(rigid, lines);
  const PlayFit found = find_play_from(motion, start, lines.JTJ);
  if (found.fits) return found;
  const auto softer = softer_start(motion, start);
  return softer ? find_play_from(motion, *softer, lines.JTJ) : found;
}

GapFit fit_play_again(const ArmMotion& motion, const PerMass& rigid, const PerMass& rigid_bare,
                      const PlayFit& bare) {
  const GapSought sought{.play = bare.seen, .friction = bare.friction.seen};
  double scale = 1;
  for (int i = 0; i < 3; ++i) {
    scale *= rigid.theta[PerMass::kGain + i] / rigid_bare.theta[PerMass::kGain + i];
  }
  scale = math::pow(scale, 1.0 / 3);
  Gap::Vector from = bare.best().theta;
  from.segment<3>(Gap::kGain) *= scale;
  from.segment<2>(Gap::kViscous) *= scale;
  from.segment<9>(Gap::kInertia) *= scale;
  from.tail<6>() *= scale;
  from.segment<3>(Gap::kWeight) = rigid.theta.segment<3>(PerMass::kWeight);
  const GapFit close = fit_gap(GapPieces(motion, kShortPieces, kShort), from, sought, 20);
  return fit_gap(GapPieces(motion, kLongPieces, kLong), close.theta, sought, 20);
}

}  // namespace thimble::bringup
