#include "bringup/identify/identify.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "bringup/identify/cables/backlash/backlash_constants.h"
#include "bringup/identify/cables/behind_cables.h"
#include "bringup/identify/joint_friction_fit.h"
#include "bringup/identify/line_forces.h"
#include "bringup/identify/link_inertia/link_constants.h"
#include "bringup/identify/link_inertia/link_equations.h"
#include "bringup/identify/record_motion.h"
#include "bringup/push_direction.h"
#include "log/progress.h"
#include "math/elementary.h"

namespace thimble::bringup {
namespace {

// Errors due to the smoothing of velocities' signs and to held torques, beyond the statistics
// [chosen: so that intervals hold 95 % of the truths of hidden arms, identify_test].
constexpr double kMethodMass = 0.0004;     // of mass
constexpr double kMethodCoulomb = 0.0012;  // of Coulomb friction
constexpr double kMethodViscous = 0.006;   // N s/m for each N of Coulomb friction
constexpr double kMethodGain = 0.0002;     // of a gain
constexpr double kMethodDelay = 2e-6;      // s
constexpr double kPlaceLead = 0.5;         // s, motion about a pose before it is recorded
// For the progress: way to a pose, s, ticks per second of a BenchArm, and the share of the time
// that is motion, of a real arm [chosen: fits take seconds].
constexpr double kWayToPlace = 2, kTicksPerSecond = 1000, kMotionShare = 0.95;
// Max. half-width of an interval over the value, of mass and gains; less precise constants are not
// written.
constexpr double kUnknownMax = 0.03;
// Max. share of the squared residual with waves or joints removed, if the fit stays bad [chosen as
// for saturation.cpp].
constexpr double kCleanedLeft = 0.3;
// Gain of the Bayesian information criterion required to name cables as the cause.
constexpr double kCablesBetter = 20;

void widen(ArmConstants& constants) {
  widen(constants.mass, kMethodMass * constants.mass.value);
  widen(constants.coulomb, kMethodCoulomb * constants.coulomb.value);
  widen(constants.viscous, kMethodViscous * constants.coulomb.value);
  for (Estimate& gain : constants.gain) widen(gain, kMethodGain * gain.value);
  widen(constants.delay, kMethodDelay);
}

/// Lists the constants whose intervals are too wide to be written.
void look_at_intervals(Identified& found) {
  const ArmConstants& constants = found.constants;
  double widest = constants.mass.plus_minus / constants.mass.value;
  for (const Estimate& gain : constants.gain)
    widest = std::max(widest, gain.plus_minus / gain.value);
  // Written so that NaN is too wide.
  if (widest < kUnknownMax) return;
  found.against.push_back(fmt::format(
      "The tip moved too little compared with its dry friction; masses and forces are known only "
      "to {:.0f} %. Record for longer (--duration), or use a heavier known mass.",
      100 * widest));
}

/// Adds the result of motion over the workspace for the tip without its links: `bare` then has
/// these links removed.
void put_links(Identified& found, const Eigen::Vector3d& down_B) {
  const LinkFit& fit = *found.over.fit;
  const auto is = tip_and_links(fit, down_B);
  if (!is) {
    found.against.push_back(is.error().message);
    return;
  }
  ArmConstants& constants = found.constants;
  constants.mass = is->mass;
  constants.weight = is->weight;
  constants.links = is->links;
  constants.viscous = fit.constant(LinkFit::kViscous);
  constants.coulomb = fit.constant(LinkFit::kCoulomb);
  for (std::size_t i = 0; i < 3; ++i) {
    constants.gain[i] = fit.constant(LinkFit::kGain + static_cast<int>(i));
  }
  constants.delay = fit.delay;
  constants.absolute = fit.absolute;
}

/// Replaces a motion, its fit and its lines by a cleaned motion if the removed effect made the fit
/// worse. `left`: the remaining share of the squared residual. Returns whether it did.
bool accept_cleaned(const ArmMotion& cleaned, const MassNormalisedFit& better, double left,
                    ArmMotion& motion, MassNormalisedFit& fit, Identified& found) {
  const LineSpectrum spectrum = line_spectrum(cleaned);
  const CableFit lines = fit_cables(spectrum, better, cleaned.dt);
  const bool good = fit_warnings(better, better, 1).empty();
  if (lines.stretches || !(good || left < kCleanedLeft)) return false;
  motion = cleaned;
  fit = better;
  found.spectrum = spectrum;
  found.lines = lines;
  return true;
}

/// Searches for cogging and ripple of the motors in the motion of a rigid arm with its bare tip.
/// Removes them from the motion if they made its fit worse, and computes fit and lines again.
driver::Result<void> look_for_cogging(const scene::ArmFile& file, ArmMotion& motion,
                                      MassNormalisedFit& fit, Identified& found) {
  if (found.lines.stretches) {
    found.waves.not_done = "not searched because the cables stretch.";
    return {};
  }
  const auto held = fit_motion(motion, true);
  if (!held) return held.error();
  Eigen::Vector3d ratio;
  for (std::size_t i = 0; i < 3; ++i) {
    ratio[static_cast<Eigen::Index>(i)] = file.model.drives[i].ratio;
  }
  auto waves = find_cogging(motion, *held, ratio, file.simulated.drive_train.periods_per_turn);
  if (!waves) return waves.error();
  if (!waves->seen()) {
    found.waves = std::move(waves).value();
    return {};
  }
  const ArmMotion cleaned = without_cogging(motion, *waves);
  const auto better = fit_motion(cleaned, false);
  if (!better) return better.error();
  if (!accept_cleaned(cleaned, *better, waves->left, motion, fit, found)) {
    found.waves.not_done = "not reported because another effect spoils the fit and looks similar.";
    return {};
  }
  found.waves = std::move(waves).value();
  return {};
}

/// Searches for friction of the joints of a rigid arm in its motion with the bare tip. Removes it
/// from the motion if it made the fit worse, and computes fit and lines again.
driver::Result<void> look_for_joint_friction(ArmMotion& motion, MassNormalisedFit& fit,
                                             Identified& found) {
  if (found.lines.stretches) return {};
  auto rubbing = fit_joint_friction(motion, fit);
  if (!rubbing) return rubbing.error();
  found.rubbing = std::move(rubbing).value();
  if (!found.rubbing.seen) return {};
  const ArmMotion cleaned = without_joint_friction(motion, found.rubbing, fit);
  const auto better = fit_motion(cleaned, false), held = fit_motion(cleaned, true);
  if (!better) return better.error();
  if (!held) return held.error();
  const auto mass = arm_constants(*better, motion.down_B, {}, 0);
  // A hand looks similar to joints that stick.
  const bool is_held_then = !mass || is_held(*held, mass->mass.value);
  if (is_held_then || !accept_cleaned(cleaned, *better, found.rubbing.left, motion, fit, found)) {
    found.rubbing = {};
  }
  return {};
}

/// Removes the effects of motors and joints found for the same arm from the motion with the known
/// mass.
driver::Result<void> remove_known_effects(ArmMotion& motion, const Identified& found) {
  motion = without_cogging(motion, found.waves);
  if (!found.rubbing.seen) return {};
  const auto fit = fit_motion(motion, false);
  if (!fit) return fit.error();
  motion = without_joint_friction(motion, found.rubbing, *fit);
  return {};
}

/// Sets the friction at the tip to the one found in addition to that of joints; none if none was
/// needed.
void put_joint_friction(Identified& found) {
  const JointFrictionFit& rubbing = found.rubbing;
  if (!rubbing.seen) return;
  const Estimate mass = found.moved_mass();
  const auto put = [&](Estimate& one, const Estimate& per_mass) {
    one = rubbing.tip_rubs
              ? Estimate{mass.value * per_mass.value, math::hypot(mass.value * per_mass.plus_minus,
                                                                  mass.plus_minus * per_mass.value)}
              : Estimate{0, std::abs(one.value) + one.plus_minus};
  };
  put(found.constants.coulomb, rubbing.tip_coulomb);
  put(found.constants.viscous, rubbing.tip_viscous);
}

/// Measures properties independent of the motion: timing of reports, and the firmware's watchdog.
void look_at_link(BenchArm& bench, const scene::ArmFile& file, const ArmConstants& bare,
                  double max_force, const std::atomic<bool>& stop, Identified& found) {
  constexpr double kListened = 2, kRested = 1;  // s
  bench.watch({});
  found.reports = time_reports(bench, kListened, stop);
  found.encoders.rest = encoders_at_rest(bench, kRested, stop);
  // An arm whose motion is not understood gets no further force. Behind an elastic cable the
  // oscillation of the link hides the end of the force.
  if (!found.against.empty() || found.lines.stretches) return;
  // Effect of these motors for a force along the direction of the push.
  const Eigen::Matrix3d J_T = found.moved.samples.back().G.inverse().transpose();
  const Eigen::Vector3d direction_W = push_direction(file);
  const Eigen::Vector3d push_B = file.R_WB.transpose() * direction_W;
  const Eigen::Matrix3d masses =
      Eigen::Matrix3d::Identity() + links_at_tip(found.moved.links, found.moved.samples.back());
  const double yields = push_B.dot(masses.inverse() * push_B);
  Eigen::Vector3d tau = J_T * push_B;
  for (std::size_t i = 0; i < 3; ++i) tau[static_cast<Eigen::Index>(i)] *= bare.gain[i].value;
  const double share = push_B.dot(J_T.inverse() * tau);
  if (!(share > 0.2)) return;
  // Friction of the joints along it.
  double rubs = 0;
  const Eigen::Vector3d turned = found.moved.samples.back().G * push_B;
  for (std::size_t i = 0; found.rubbing.seen && i < 3; ++i) {
    rubs += std::abs(turned[static_cast<Eigen::Index>(i)]) *
            by_gain(found.rubbing.coulomb[i], bare.gain[i]).value;
  }
  found.watchdog = watchdog_time(bench,
                                 {.named = 1e-9 * static_cast<double>(file.limits.watchdog_ns),
                                  .mass = bare.mass.value / (yields * share),
                                  .coulomb = (bare.coulomb.value + rubs) / share,
                                  .delay = bare.delay.value,
                                  .workspace = file.workspace,
                                  .max_force = max_force,
                                  .direction_W = direction_W},
                                 file.limits.soft_start, stop);
}

void report_stiction(Identified& found, int joint, const Estimate& coulomb) {
  found.against.insert(
      found.against.begin(),
      fmt::format("Joint {} sticks: it has {:.2g} +- {:.1g} N m of dry friction in addition to "
                  "that of the tip. Check its cable, bearing and motor.",
                  joint + 1, coulomb.value, coulomb.plus_minus));
}

/// Searches the residual of the fit for unmodelled effects. A hand (`held`) looks like joints that
/// stick, so these are not searched for then.
void look_closer(Identified& found, bool held) {
  // The position of the links in their backlash is unknown, and behind motors with friction it is
  // only approximate.
  if (found.play.is_reported()) return;
  const FittedMotion motion = found.fitted();
  const Estimate mass = found.moved_mass();
  found.friction = friction_directions(motion, mass);
  if (found.rubbing.seen) {
    const Eigen::Matrix3d& G = found.moved.samples.back().G;
    const int stuck =
        found.rubbing.stuck(found.constants.coulomb.value, G.rowwise().norm().cwiseInverse());
    if (stuck >= 0)
      report_stiction(found, stuck, found.joint_coulomb(static_cast<std::size_t>(stuck)));
  } else if (!found.against.empty() && !held) {
    const JointFrictionFit left = joint_friction_left(motion);
    const auto joint = static_cast<std::size_t>(left.strongest_joint());
    if (left.seen) {
      report_stiction(found, left.strongest_joint(),
                      by_gain(left.coulomb[joint], found.constants.gain[joint]));
    }
  }
  if (found.lines.stretches) return;
  found.saturation = saturations(motion);
  for (std::size_t i = 0; i < 3; ++i) {
    const Saturation& one = found.saturation[i];
    if (!one.seen) continue;
    found.against.insert(
        found.against.begin(),
        fmt::format(
            "Motor {} gives at most {:.3g} +- {:.1g} N m at the joint, but up to {:.3g} N m was "
            "requested. Its amplifier saturates, or current_max in the arm file is too high.",
            i + 1, one.max_torque.value, one.max_torque.plus_minus, one.asked));
  }
}

std::string like_play_text(const BacklashResult& play) {
  return fmt::format(
      "The motors move as if the cables had backlash, but a model with backlash does not fit "
      "either (chi^2 {:.1f} per degree of freedom, {:.0f} without). Possible causes: friction that "
      "varies, slack that varies, or a hand.",
      play.with.misfit, play.without.misfit);
}

/// Adds the lateness of a bench's ticks to a sum when it is destroyed, whatever ended the run.
class LateCounter {
 public:
  LateCounter(const BenchArm& bench, LateTicks& sum) : bench_(bench), sum_(sum) {}
  ~LateCounter() { sum_.add(bench_.late()); }
  LateCounter(const LateCounter&) = delete;
  LateCounter& operator=(const LateCounter&) = delete;

 private:
  const BenchArm& bench_;
  LateTicks& sum_;
};

/// Returns an error if an arm cannot be identified with these options.
driver::Result<void> check_asked(const scene::ArmFile& file, const IdentifyOptions& options) {
  if (auto asked = check_places(file, options); !asked) return asked;
  if (file.is<driver::VendorPoseArm>()) {
    return driver::Error{
        "Only arms whose joint motors are controlled by current can be identified (PHANTOM, "
        "WoodenHaptics, Polhem, Falcon). Vendor-driven arms do not report their currents."};
  }
  if (!(options.seconds >= 10 && options.seconds <= 600)) {
    return driver::Error{"The duration of a motion must be 10 to 600 s."};
  }
  return check_forces(file, options);
}

/// The steps of an identification, for the motion with the bare tip and then for the one with the
/// known mass. For each: record it, remove the effects of motors, joints and cables, fit it, store
/// it. Finally judge both and write the constants.
class Identification {
 public:
  Identification(const OpenBench& open, const scene::ArmFile& file, const IdentifyOptions& options,
                 const std::atomic<bool>& stop, LateTicks& late)
      : open_(open), file_(file), options_(options), stop_(stop), late_(late) {}

  driver::Result<Identified> run() {
    if (auto asked = check_asked(file_, options_); !asked) return asked.error();
    if (auto done = move(false); !done) return done.error();
    if (options_.known_mass != 0) {
      if (auto done = move(true); !done) return done.error();
    }
    return write();
  }

 private:
  /// A motion during its processing. `links`: that of the links, with elastic cables.
  struct Motion {
    ArmMotion recorded;
    ArmMotion links;
    MassNormalisedFit fit;
    std::optional<MassNormalisedFit> held;  ///< Fit with a hand on the tip.
  };

  driver::Result<void> move(bool loaded) {
    auto bench = open_(loaded);
    if (!bench) return bench.error();
    const LateCounter counter(**bench, late_);
    scene::Progress progress(loaded ? "identify, known mass" : "identify");
    count_ticks(**bench, loaded, progress);
    Motion motion;
    if (auto done = record(**bench, loaded, motion); !done) return done;
    if (auto done = loaded ? clean_loaded(motion) : clean_bare(motion); !done) return done;
    if (auto done = look_behind_cables(loaded, motion); !done) return done;
    if (auto done = loaded ? take_links_of_loaded(motion) : look_over(**bench, motion); !done) {
      return done;
    }
    if (auto done = remove_links(motion); !done) return done;
    keep(loaded, motion);
    const auto alone = arm_constants(motion.fit, down_B_, {}, 0);
    if (!alone) return alone.error();
    judge(loaded, motion, *alone);
    if (loaded) {
      progress.set_share(1.0);
      return {};
    }
    if (options_.link) look_at_link(**bench, file_, *alone, options_.max_force, stop_, found_);
    progress.set_share(1.0);
    read_late_ = (*bench)->read_late();
    return {};
  }

  /// Passes the ticks of a motion to the caller, and counts them for the progress.
  void count_ticks(BenchArm& bench, bool loaded, scene::Progress& progress) {
    const double moved = options_.lead + options_.seconds;
    const double poses =
        loaded ? 0 : options_.places * (options_.place_seconds + kPlaceLead + kWayToPlace);
    const double planned = (moved + poses) / kMotionShare * kTicksPerSecond;
    bench.watch(
        [this, loaded, planned, ticks = 0.0, &progress](const driver::TickRecord& tick) mutable {
          if (!loaded && options_.watch) options_.watch(tick);
          progress.set_share(std::min(++ticks / planned, kMotionShare));
        });
  }

  driver::Result<void> record(BenchArm& bench, bool loaded, Motion& motion) {
    auto recorded = record_motion(bench, file_,
                                  {.seconds = options_.seconds,
                                   .lead = options_.lead,
                                   .added_mass = loaded ? options_.known_mass : 0,
                                   .max_force = options_.max_force,
                                   .seed = options_.seed + (loaded ? 1 : 0),
                                   .share = share_},
                                  stop_);
    if (!recorded) return recorded.error();
    motion.recorded = std::move(recorded).value();
    share_ = motion.recorded.share;
    down_B_ = motion.recorded.down_B;
    return {};
  }

  driver::Result<void> clean_bare(Motion& motion) {
    auto fit = fit_motion(motion.recorded, false);
    if (!fit) return fit.error();
    motion.fit = *fit;
    found_.encoders.step = encoder_steps(motion.recorded);
    // These searches need the motion of three joints.
    if (motion.recorded.motors < 3) return {};
    found_.spectrum = line_spectrum(motion.recorded);
    found_.lines = fit_cables(found_.spectrum, motion.fit, motion.recorded.dt);
    if (auto done = look_for_cogging(file_, motion.recorded, motion.fit, found_); !done)
      return done;
    if (options_.play) {
      if (auto done = look_for_joint_friction(motion.recorded, motion.fit, found_); !done)
        return done;
    }
    if (options_.cables) return {};
    cables_better_ = found_.lines.better;
    found_.lines = {};
    return {};
  }

  driver::Result<void> clean_loaded(Motion& motion) {
    // All torques come through the same motors.
    if (auto done = remove_known_effects(motion.recorded, found_); !done) return done;
    auto fit = fit_motion(motion.recorded, false);
    if (!fit) return fit.error();
    motion.fit = *fit;
    return {};
  }

  /// Computes the motion of the links, if cables stretch or have backlash.
  driver::Result<void> look_behind_cables(bool loaded, Motion& motion) {
    motion.links = motion.recorded;
    if (!loaded && options_.play && found_.lines.stretches) {
      found_.play = find_backlash(motion.recorded, motion.fit, found_.lines);
      if (found_.play.looks_like_backlash) found_.against.push_back(like_play_text(found_.play));
    }
    if (found_.play.fits_to_steps()) {
      if (auto done = take_play(loaded, motion); !done) return done;
    } else if (found_.lines.stretches) {
      // A mass on the tip changes neither motors nor cables.
      auto behind = behind_cables(motion.recorded, file_, found_.lines, !loaded, motion.fit);
      if (!behind) return behind.error();
      motion.links = std::move(behind).value();
    }
    if (motion.held) return {};
    auto held = fit_motion(motion.links, true);
    if (!held) return held.error();
    motion.held = *held;
    return {};
  }

  driver::Result<void> take_play(bool loaded, Motion& motion) {
    const BacklashFit backlash =
        loaded ? fit_backlash_again(motion.recorded, motion.fit, rigid_, found_.play)
               : found_.play.best();
    rigid_ = motion.fit;
    if (!loaded) {
      found_.lines.elastic = two_mass_of(backlash, found_.lines.elastic);
      found_.lines.rotor_viscous = backlash.theta.segment<3>(BacklashTheta::kRotorViscous);
      found_.lines.rotor_coulomb = backlash.theta.segment<3>(BacklashTheta::kRotorCoulomb);
    }
    auto behind = motion_of_links(motion.recorded, found_.lines, file_);
    if (!behind) return behind.error();
    motion.links = std::move(behind).value();
    motion.fit = mass_normalised_fit_of(backlash, motion.recorded);
    motion.held = motion.fit;
    return {};
  }

  /// Moves the bare tip about other poses of the workspace, which separates the links' effects.
  driver::Result<void> look_over(BenchArm& bench, const Motion& motion) {
    const auto mass = arm_constants(motion.fit, down_B_, {}, 0);
    auto over = sweep_workspace(
        bench, file_,
        {.seconds = options_.place_seconds,
         .lead = kPlaceLead,
         .max_force = options_.max_force,
         .seed = options_.seed + 2,
         .share = share_},
        options_.places, motion.links,
        [&](const ArmMotion& other) {
          return without_joint_friction(without_cogging(other, found_.waves), found_.rubbing,
                                        motion.fit);
        },
        found_.lines.stretches, mass.ok() && is_held(*motion.held, mass->mass.value), stop_);
    if (!over) return over.error();
    found_.over = std::move(over).value();
    return {};
  }

  driver::Result<void> take_links_of_loaded(const Motion& motion) {
    if (!found_.over.links()) return {};
    return add_loaded(found_.over, motion.links, file_);
  }

  /// Removes the links from the motion, if they were identified: the remainder is the tip's.
  driver::Result<void> remove_links(Motion& motion) {
    if (!found_.over.links()) return {};
    motion.links = without_link_inertia(motion.links, *found_.over.fit);
    auto fit = fit_motion(motion.links, false);
    if (!fit) return fit.error();
    motion.fit = *fit;
    auto held = fit_motion(motion.links, true);
    if (!held) return held.error();
    motion.held = *held;
    return {};
  }

  void keep(bool loaded, const Motion& motion) {
    if (loaded) {
      found_.loaded = motion.fit;
      return;
    }
    found_.bare = motion.fit;
    found_.moved = motion.links;
    if (found_.lines.stretches) {
      found_.moved_ahead =
          found_.lines.elastic.theta[TwoMass::kDelay] - kDelayTicks * motion.recorded.dt;
    }
  }

  /// Records reasons to distrust a fit.
  void judge(bool loaded, const Motion& motion, const ArmConstants& alone) {
    held_tip_ = held_tip_ || is_held(*motion.held, alone.mass.value);
    for (std::string& sentence :
         fit_warnings(motion.fit, *motion.held, alone.mass.value, found_.lines.stretches)) {
      found_.against.push_back((loaded ? "With the known mass: " : "") + sentence);
    }
    if (loaded || !(cables_better_ > kCablesBetter)) return;
    found_.against.push_back(
        fmt::format("Above {:g} Hz the arm does not move like a rigid arm; a model with a mass "
                    "behind each cable fits better (Bayesian information criterion lower by "
                    "{:.0f}). Its cables stretch, but cables were not searched.",
                    LineForces::kLowest, cables_better_));
  }

  /// Computes the constants from both motions, and the reasons to distrust them.
  driver::Result<Identified> write() {
    auto constants = arm_constants(found_.bare, down_B_, found_.loaded, options_.known_mass);
    if (!constants) return constants.error();
    found_.constants = *constants;
    constexpr double kMisfitMax = 50;
    if (found_.loaded && found_.lines.stretches) {
      const auto apart = arm_constants(with_method(found_.bare), down_B_,
                                       with_method(*found_.loaded), options_.known_mass);
      found_.constants.misfit = apart ? apart->misfit : HUGE_VAL;
    }
    if (found_.constants.misfit > kMisfitMax) {
      found_.against.push_back(fmt::format(
          "The two motions do not fit one arm with an added mass of {:g} kg (chi^2 {:.0f} per "
          "degree of freedom). Weigh the mass, and fix it so that it does not swing.",
          options_.known_mass, found_.constants.misfit));
    }
    found_.constants.links_sought = found_.over.fit.has_value();
    if (found_.over.links()) put_links(found_, down_B_);
    // Reports waited for their tick; the delay of the arm is the mean without that wait.
    found_.constants.delay.value -= read_late_;
    widen(found_.constants);
    put_joint_friction(found_);
    if (found_.lines.stretches) put_cables(found_);
    look_at_intervals(found_);
    look_closer(found_, held_tip_);
    found_.over.motions.clear();
    return std::move(found_);
  }

  const OpenBench& open_;
  const scene::ArmFile& file_;
  const IdentifyOptions& options_;
  const std::atomic<bool>& stop_;
  LateTicks& late_;
  Identified found_;
  Eigen::Vector3d down_B_{0, 0, -1}, share_{1, 1, 1};
  bool held_tip_ = false;
  MassNormalisedFit rigid_;   // fit of the motion with the bare tip
  double cables_better_ = 0;  // gain by cables that were not requested
  double read_late_ = 0;      // s
};

}  // namespace

driver::Result<Identified> identify(const OpenBench& open, const scene::ArmFile& file,
                                    const IdentifyOptions& options, const std::atomic<bool>& stop) {
  LateTicks late;
  auto found = Identification(open, file, options, stop, late).run();
  if (!found) {
    if (!late.many() || stop.load()) return found;
    return driver::Error{late_ticks_text(late) + " (" + found.error().message + ")"};
  }
  found->late = late;
  if (late.many() && !found->against.empty()) found->against = {late_ticks_text(late)};
  return found;
}

}  // namespace thimble::bringup
