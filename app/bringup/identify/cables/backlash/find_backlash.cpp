#include "bringup/identify/cables/backlash/find_backlash.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "bringup/identify/arm_constants.h"
#include "bringup/identify/cables/backlash/backlash_constants.h"
#include "math/elementary.h"

namespace thimble::bringup {
namespace {

using Theta = BacklashTheta;

// Pieces of motion, and their ticks. Short ones are for the search, where a wrong start has little
// effect; long ones for the constants, which slow motion shows.
constexpr std::size_t kShortPieces = 60, kShort = 40, kMiddle = 60, kLongPieces = 50, kLong = 80;
constexpr double kFitsAlready = 1.1, kFitsNearly = 1.5;  // chi^2 per degree of freedom
constexpr double kFits = 2;
// Error of the search beyond the statistics, as one standard deviation [chosen: so that intervals
// hold 95 % of the truths of hidden arms, identify_backlash_test]: of a width, and rad.
constexpr double kMethodShare = 0.006, kMethodWidth = 3e-6;
// Likewise half-widths of intervals of the friction of motors, N m s/rad and N m. By statistics
// only, arms with wide backlash and no friction get up to 6e-5 N m [identify_joint_friction_test,
// identify_backlash_test].
constexpr double kMethodViscous = 5e-5, kMethodCoulomb = 3e-5;
// Max. damping of a cable over its stiffness, s: a part with more losses is not a spring [chosen:
// at 40 Hz more than 0.6 of the critical damping].
constexpr double kFadeMax = 5e-3, kFade = 3e-4;
constexpr double kBacklashBetter = 20;  // information required for acceptance
constexpr double kBacklashShows = 5;    // deviations required to write a number

bool is_spring(const Theta::Vector& theta, int joint) {
  return theta[Theta::kDamping + joint] < kFadeMax * theta[Theta::kStiffness + joint];
}
bool are_springs(const BacklashFit& fit) {
  return is_spring(fit.theta, 0) && is_spring(fit.theta, 1) && is_spring(fit.theta, 2);
}

/// Takes another fit if its residual is smaller.
void keep_better(BacklashFit& best, const BacklashFit& other) {
  if (other.misfit < best.misfit) best = other;
}

/// Leaves a local minimum for a better one. A motor that mostly stands still hides its cable, and a
/// soft one with large losses looks the same. Starts from stiffer cables with small losses.
void leave_valley(const BacklashPieces& whole, const BacklashSought& sought, BacklashFit& fit) {
  constexpr double kStiffer[] = {2, 6};
  for (int joint = 0; joint < 3; ++joint) {
    for (const double stiffer : kStiffer) {
      if (is_spring(fit.theta, joint)) break;
      Theta::Vector from = fit.theta;
      from[Theta::kStiffness + joint] *= stiffer;
      from[Theta::kDamping + joint] = kFade * from[Theta::kStiffness + joint];
      keep_better(fit, fit_backlash(whole, from, sought, 20));
    }
  }
}

/// Searches for backlash from several widths.
BacklashFit search_backlash(const ArmMotion& motion, const Theta::Vector& start,
                            const BacklashFit& without, bool friction) {
  const BacklashSought sought{.play = true, .friction = friction};
  const BacklashPieces pieces(motion, kShortPieces, kShort);
  Theta::Vector from = without.theta;
  if (without.misfit < kFitsNearly) {
    from.segment<3>(Theta::kBacklash) = motion.step;
    return fit_backlash(pieces, from, sought, 20);
  }
  // In encoder steps: less than one is not visible, and far more than 15 is not a cable.
  constexpr double kWidths[] = {2, 5, 13};
  constexpr double kStiffer = 2;  // stiffness of a cable relative to a fit without backlash
  const BacklashPieces few(motion, 24, kShort);
  BacklashFit best;
  for (const double width : kWidths) {
    from = start;
    from.segment<3>(Theta::kStiffness) *= kStiffer;
    from.segment<3>(Theta::kBacklash) = width * motion.step;
    keep_better(best, fit_backlash(few, from, sought, 5));
  }
  best = fit_backlash(pieces, best.theta, sought, 25);
  // One joint may be in another local minimum, so its other start values are tried.
  for (int sweep = 0; sweep < 2; ++sweep) {
    for (int joint = 0; joint < 3; ++joint) {
      for (const double wider : {0.4, 2.5}) {
        if (best.misfit < kFitsNearly) return best;
        from = best.theta;
        from[Theta::kBacklash + joint] =
            wider * std::max(from[Theta::kBacklash + joint], motion.step[joint]);
        const BacklashFit other = fit_backlash(few, from, sought, 6);
        keep_better(best, fit_backlash(pieces, other.theta, sought, 6));
      }
    }
  }
  return best;
}

/// Searches for friction of the motors, starting from the fit without it; if that does not fit,
/// from shares of a rigid arm's friction along its axes.
BacklashFit search_friction(const ArmMotion& motion, const BacklashPieces& pieces,
                            const Theta::Vector& start, const Eigen::Matrix3d& JTJ,
                            const BacklashFit& without) {
  const BacklashSought sought{.friction = true};
  BacklashFit best = fit_backlash(pieces, without.theta, sought, 12);
  if (best.misfit < kFitsAlready) return best;
  const BacklashPieces few(motion, 24, kShort);
  BacklashFit other;
  for (const double share : {0.3, 0.6}) {
    Theta::Vector from = start;
    from[Theta::kCoulomb] *= 1 - share;
    for (int i = 0; i < 3; ++i) {
      from[Theta::kRotorCoulomb + i] = share * start[Theta::kCoulomb] * std::sqrt(JTJ(i, i));
    }
    keep_better(other, fit_backlash(few, from, sought, 8));
  }
  keep_better(best, fit_backlash(pieces, other.theta, sought, 15));
  return best;
}

/// Returns the gain of the Bayesian information criterion by a fit with `count` more constants.
double better_by(const BacklashFit& without, const BacklashFit& with, int count) {
  const double misfit = std::max(1.0, with.misfit);
  return (without.chi2 / without.samples - with.chi2 / with.samples) * with.samples / misfit -
         count * math::log(with.samples);
}

/// Judges the fits without and with backlash.
void judge_backlash(BacklashResult& found) {
  found.better = better_by(found.without, found.with, 3);
  found.fits = std::min(found.without.misfit, found.with.misfit) < kFits && found.with.lost < 0.25;
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double error =
        std::sqrt(found.with.covariance(Theta::kBacklash + i, Theta::kBacklash + i));
    const double width = found.with.theta[Theta::kBacklash + i];
    const double method = math::hypot(kMethodShare * width, kMethodWidth);
    found.width[k] = {width, kNormal95 * math::hypot(error, method)};
    found.shows[k] = width > kBacklashShows * math::hypot(error, kMethodWidth);
  }
  found.looks_like_backlash = !found.fits && found.with.misfit < 0.5 * found.without.misfit;
  found.seen = found.fits && found.with.misfit < kFits && found.better > kBacklashBetter &&
               std::any_of(found.shows.begin(), found.shows.end(), [](bool one) { return one; });
}

/// Returns one constant over the gain of its motor; the interval includes their correlation.
Estimate over_gain(const BacklashFit& fit, int k, int joint) {
  const int g = Theta::kGain + joint;
  const double gain = fit.theta[g], ratio = fit.theta[k] / gain;
  const double variance = fit.covariance(k, k) - 2 * ratio * fit.covariance(k, g) +
                          ratio * ratio * fit.covariance(g, g);
  return {ratio, kNormal95 * std::sqrt(std::max(0.0, variance)) / gain};
}

/// Judges a fit with friction of the motors, compared with the same fit without it.
RotorFriction judge_friction(const BacklashFit& without, const BacklashFit& with) {
  RotorFriction found;
  found.better = better_by(without, with, 6);
  bool any = false;
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const auto take = [&](int from, double method, Estimate& to, bool& shows) {
      to = over_gain(with, from + i, i);
      widen(to, method);
      shows = to.value > kBacklashShows / kNormal95 * to.plus_minus;
      any = any || shows;
    };
    take(Theta::kRotorViscous, kMethodViscous, found.viscous[k], found.shows_viscous[k]);
    take(Theta::kRotorCoulomb, kMethodCoulomb, found.coulomb[k], found.shows_coulomb[k]);
  }
  // A search that ended in another local minimum leaves a somewhat larger residual, and friction
  // that is far off.
  found.fits = with.misfit < kFitsAlready && are_springs(with);
  found.seen = any && found.fits && found.better > kBacklashBetter;
  return found;
}

/// Searches for friction of the motors in addition to the fit without it.
void look_for_friction(const BacklashPieces& whole, BacklashResult& found) {
  BacklashResult both = found;
  BacklashFit& best = found.seen ? both.with : both.without;
  best = fit_backlash(whole, best.theta, {.play = found.seen, .friction = true}, 15);
  leave_valley(whole, {.play = found.seen, .friction = true}, best);
  if (!found.fits) {
    // A motion that did not fit without friction may have backlash, or only friction.
    both.with = fit_backlash(whole, found.with.theta, {.play = true, .friction = true}, 20);
  }
  judge_backlash(both);
  both.friction = judge_friction(both.seen ? found.with : found.without, both.best());
  found.friction = both.friction;
  if (both.friction.seen) found = both;
}

/// Returns constants that explain a motion without backlash and friction of motors, with springs
/// softer than in `start` and with smaller losses. Lines mislead if a link oscillates below the
/// lowest of them. Empty if there are none: a motor that mostly stands still shows too little for
/// that.
std::optional<Theta::Vector> softer_start(const ArmMotion& motion, const Theta::Vector& start) {
  constexpr double kSofter[] = {0.5, 0.25, 0.125};  // than the lines show
  const BacklashPieces few(motion, 24, kShort);
  BacklashFit best;
  for (const double share : kSofter) {
    Theta::Vector from = start;
    from.segment<3>(Theta::kStiffness) *= share;
    from.segment<3>(Theta::kDamping) = kFade * from.segment<3>(Theta::kStiffness);
    keep_better(best, fit_backlash(few, from, {}, 12));
  }
  best = fit_backlash(BacklashPieces(motion, kShortPieces, kShort), best.theta, {}, 15);
  if (!(best.misfit < kFitsNearly)) return {};
  best = fit_backlash(BacklashPieces(motion, kLongPieces, kLong), best.theta, {}, 15);
  if (!(best.misfit < kFitsAlready)) return {};
  return best.theta;
}

/// Searches for backlash and friction of the motors from constants without either.
BacklashResult find_backlash_from(const ArmMotion& motion, const Theta::Vector& start,
                                  const Eigen::Matrix3d& JTJ) {
  BacklashResult found;
  found.searched = true;
  const BacklashPieces brief(motion, kShortPieces, kShort), whole(motion, kLongPieces, kLong);
  const BacklashFit plain = fit_backlash(brief, start, {}, 15);
  // If only friction of the motors is missing, backlash is searched for in addition to it.
  const BacklashFit rubbed = search_friction(motion, brief, start, JTJ, plain);
  const bool rubs = rubbed.misfit < kFitsNearly && better_by(plain, rubbed, 6) > kBacklashBetter;
  const BacklashFit& without = rubs ? rubbed : plain;
  const BacklashFit with = search_backlash(motion, start, without, rubs);
  const BacklashSought sought{.play = true, .friction = rubs};
  const BacklashPieces middle(motion, kLongPieces, kMiddle);
  if (rubs) {
    const BacklashFit near = fit_backlash(middle, without.theta, {.friction = true}, 15);
    found.without = fit_backlash(whole, near.theta, {.friction = true}, 20);
    leave_valley(whole, {.friction = true}, found.without);
  } else {
    found.without = fit_backlash(whole, without.theta, {}, 10);
  }
  const BacklashFit closer = fit_backlash(middle, with.theta, sought, 15);
  found.with = fit_backlash(whole, closer.theta, sought, 20);
  if (rubs) leave_valley(whole, sought, found.with);
  judge_backlash(found);
  found.plain = found.without;
  if (!rubs) {
    look_for_friction(whole, found);
    return found;
  }
  if (!found.seen && found.with.misfit < found.without.misfit) {
    // Backlash too small to be seen improves nothing; then the cause is another local minimum.
    Theta::Vector tight = found.with.theta;
    tight.segment<3>(Theta::kBacklash).setZero();
    keep_better(found.without, fit_backlash(whole, tight, {.friction = true}, 20));
    judge_backlash(found);
  }
  Theta::Vector smooth = found.best().theta;
  smooth.tail<6>().setZero();
  const BacklashFit other = fit_backlash(whole, smooth, {.play = found.seen}, 10);
  found.friction = judge_friction(other, found.best());
  found.plain = found.seen ? fit_backlash(whole, plain.theta, {}, 10) : other;
  return found;
}

}  // namespace

bool BacklashResult::fits_to_steps() const {
  return is_reported() || (searched && fits && best().misfit < kFitsAlready && are_springs(best()));
}

BacklashResult find_backlash(const ArmMotion& motion, const MassNormalisedFit& rigid,
                             const CableFit& lines) {
  const Theta::Vector start = backlash_constants(rigid, lines);
  const BacklashResult found = find_backlash_from(motion, start, lines.JTJ);
  if (found.fits) return found;
  const auto softer = softer_start(motion, start);
  return softer ? find_backlash_from(motion, *softer, lines.JTJ) : found;
}

BacklashFit fit_backlash_again(const ArmMotion& motion, const MassNormalisedFit& rigid,
                               const MassNormalisedFit& rigid_bare, const BacklashResult& bare) {
  const BacklashSought sought{.play = bare.seen, .friction = bare.friction.seen};
  double scale = 1;
  for (int i = 0; i < 3; ++i) {
    scale *=
        rigid.theta[MassNormalisedFit::kGain + i] / rigid_bare.theta[MassNormalisedFit::kGain + i];
  }
  scale = math::pow(scale, 1.0 / 3);
  Theta::Vector from = bare.best().theta;
  from.segment<3>(Theta::kGain) *= scale;
  from.segment<2>(Theta::kViscous) *= scale;
  from.segment<9>(Theta::kInertia) *= scale;
  from.tail<6>() *= scale;
  from.segment<3>(Theta::kWeight) = rigid.theta.segment<3>(MassNormalisedFit::kWeight);
  const BacklashFit close =
      fit_backlash(BacklashPieces(motion, kShortPieces, kShort), from, sought, 20);
  return fit_backlash(BacklashPieces(motion, kLongPieces, kLong), close.theta, sought, 20);
}

}  // namespace thimble::bringup
