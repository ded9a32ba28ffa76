#include "bringup/identify/identify.h"

#include <fmt/format.h>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

#include "bringup/identify/line_forces.h"
#include "bringup/identify/record_motion.h"
#include "bringup/identify/rubbing_joints.h"
#include "math/elementary.h"

namespace thimble::app {
namespace {

// What the smoothing of velocities' signs and torques that are held for a tick cost beyond the
// statistics [chosen: so that intervals hold 95 % of the truths of hidden arms, identify_test].
constexpr double kMethodMass = 0.0004;     // of mass
constexpr double kMethodCoulomb = 0.0012;  // of Coulomb friction
constexpr double kMethodViscous = 0.003;   // N s/m for each N of Coulomb friction
constexpr double kMethodGain = 0.0002;     // of a gain
constexpr double kMethodDelay = 2e-6;      // s
// What a motion behind cables costs beyond that [chosen likewise, with soft arms 1 to 20, 101 to
// 120 and 6000 to 6019 of identify_cables_test].
constexpr double kCableMass = 0.01;       // of mass; of the link's inertia for a motor's
constexpr double kCableFriction = 0.007;  // N of friction and weight for each N of Coulomb friction
constexpr double kCableViscous = 0.06;    // N s/m for each N of Coulomb friction
constexpr double kCableGain = 0.0065;     // of a gain
constexpr double kCableDelay = 2e-5;      // s
constexpr double kCableDamping = 0.05;    // of a cable's damping, with which dry friction mixes
constexpr double kCableLines = 2;         // times what the lines' noise says
// A right arm leaves 1 to 4 times what its encoders' steps do, or below 1 % of its acceleration
// where it is light; one that is another leaves more of both.
constexpr double kResidualMost = 4;
constexpr double kUnexplainedMost = 0.02;
// Behind cables what the links did is known through them alone: right soft arms leave up to 4 %, 8
// times the encoders' steps [measured: soft arms 6000 to 6012].
constexpr double kCableResidualMost = 8;
constexpr double kCableUnexplainedMost = 0.05;
// Springs below this are not told from an axis that sticks now and then.
constexpr double kSpringLeast = 10;  // N/m
// Of the pieces of motion, how many may be left out because an axis stood.
constexpr double kLeftOutMost = 0.75;
// Lines are fitted to 1 to 1.5; bent geometry and friction leave the rest.
constexpr double kLinesMisfitMost = 10;
constexpr double kForceLeast = 0.2;   // N [chosen: twice the dry friction of the arms that we know]
constexpr double kCarriedMost = 0.6;  // of the largest force, to carry a known mass
constexpr double kKnownMassMost = 0.06;  // kg [chosen: no grip should be heavier than its arm]
// Half-width of an interval over the value, of a cable, and of a motor's inertia: of one that is
// small beside its link little is known, and little hangs on it.
constexpr double kCableUnknownMost = 0.6;
constexpr double kMotorUnknownMost = 1;
// Likewise of mass and gains; what is known worse is not written.
constexpr double kUnknownMost = 0.03;
// By how much the Bayesian information must prefer cables before they are blamed.
constexpr double kCablesBlamed = 20;

void widen(Estimate& estimate, double method) {
  estimate.plus_minus = math::hypot(estimate.plus_minus, kNormal95 * method);
}

void widen(ArmConstants& constants) {
  widen(constants.mass, kMethodMass * constants.mass.value);
  widen(constants.coulomb, kMethodCoulomb * constants.coulomb.value);
  widen(constants.viscous, kMethodViscous * constants.coulomb.value);
  for (Estimate& gain : constants.gain) widen(gain, kMethodGain * gain.value);
  widen(constants.delay, kMethodDelay);
}

/// Fits the links behind cables that stretch, and with `refine` the cables again by what the slow
/// part of their motion says. Returns the motion of the links.
driver::Result<ArmMotion> behind_cables(const ArmMotion& motion, const scene::ArmFile& file,
                                        CableFit& lines, bool refine, PerMass& fit) {
  constexpr int kRounds = 2;
  // The method's errors beside those of the statistics [chosen as those above]: times a deviation,
  // and of the link's inertia.
  constexpr double kTrust = 3, kShareError = 0.02;
  const LineSpectrum spectrum = refine ? line_spectrum(motion) : LineSpectrum{};
  for (int round = 0;; ++round) {
    auto links = motion_of_links(motion, lines, file);
    if (!links) return links.error();
    const bool last = !refine || round == kRounds;
    auto seen = fit_motion(*links, false, !last);
    if (!seen) return seen.error();
    fit = *seen;
    fit.delay.value += lines.elastic.theta[TwoMass::kDelay] - kHeldBack * motion.dt;
    if (last) return links;
    SlowPart slow;
    slow.gain = fit.theta.segment<3>(PerMass::kGain);
    for (int i = 0; i < 3; ++i) {
      const int g = TwoMass::kGain + i, J = TwoMass::kInertia + i;
      slow.ratio[i] = std::max(0.0, lines.elastic.theta[J] / lines.elastic.theta[g] +
                                        fit.theta[PerMass::kInertia + i] / slow.gain[i]);
      slow.gain_error[i] = kTrust * std::sqrt(fit.covariance(i, i));
      const double error =
          kTrust * std::sqrt(fit.covariance(PerMass::kInertia + i, PerMass::kInertia + i));
      slow.ratio_error[i] = math::hypot(error, kShareError * spectrum.JTJ(i, i)) / slow.gain[i];
    }
    slow.delay = fit.delay.value;
    slow.delay_error = kTrust * std::max(2e-6, fit.delay.plus_minus / kNormal95);
    refine_cables(lines, spectrum, slow, motion.dt);
  }
}

/// Adds what the lines say of motors and cables, and what their errors make of the rest.
void put_cables(Identified& found) {
  ArmConstants& constants = found.constants;
  widen(constants.mass, kCableMass * constants.mass.value);
  widen(constants.coulomb, kCableFriction * constants.coulomb.value);
  widen(constants.viscous, kCableViscous * constants.coulomb.value);
  widen(constants.weight, kCableFriction * constants.coulomb.value);
  widen(constants.delay, kCableDelay);
  for (Estimate& gain : constants.gain) widen(gain, kCableGain * gain.value);
  constants.cables = cable_constants(found.lines, constants.gain);
  for (std::size_t i = 0; i < 3; ++i) {
    CableConstants& cable = (*constants.cables)[i];
    // What a motor's inertia is taken for too much, the link's is taken for too little.
    const auto k = static_cast<Eigen::Index>(i);
    widen(cable.inertia, kCableMass * constants.mass.value * found.lines.JTJ(k, k));
    for (Estimate* estimate :
         {&cable.stiffness, &cable.damping, &cable.antiresonance, &cable.resonance}) {
      estimate->plus_minus *= kCableLines;
    }
    widen(cable.damping, kCableDamping * cable.damping.value);
  }
  if (found.lines.elastic.misfit > kLinesMisfitMost) {
    found.against.push_back(fmt::format(
        "Above {:g} Hz the arm moves neither like a rigid one nor like one with a mass behind each "
        "cable (chi^2 {:.0f} per degree of freedom): play, a second resonance or a hand do that.",
        LineForces::kLowest, found.lines.elastic.misfit));
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const CableConstants& cable = (*constants.cables)[i];
    if (cable.inertia.plus_minus < kMotorUnknownMost * cable.inertia.value &&
        cable.stiffness.plus_minus < kCableUnknownMost * cable.stiffness.value) {
      continue;
    }
    found.against.push_back(fmt::format(
        "The cable of joint {} stretches (its link oscillates on it at {:.0f} Hz), but motor and "
        "cable are not known well enough to be written: {:.2g} +- {:.2g} kg m^2, {:.3g} +- {:.2g} "
        "N m/rad. Take more time (--seconds).",
        i + 1, cable.antiresonance.value, cable.inertia.value, cable.inertia.plus_minus,
        cable.stiffness.value, cable.stiffness.plus_minus));
  }
}

/// Returns the fit of a motion behind cables with the method's errors in its covariance: what two
/// motions of one arm differ by.
PerMass with_method(const PerMass& fit) {
  PerMass wider = fit;
  const auto add = [&wider](int k, double error) { wider.covariance(k, k) += error * error; };
  const double coulomb = fit.theta[PerMass::kCoulomb];
  for (int i = 0; i < 3; ++i) {
    add(PerMass::kGain + i, kCableGain * fit.theta[PerMass::kGain + i]);
    add(PerMass::kWeight + i, kCableFriction * coulomb);
  }
  add(PerMass::kViscous, kCableViscous * coulomb);
  add(PerMass::kCoulomb, kCableFriction * coulomb);
  return wider;
}

/// Says which constants are not known well enough to be written.
void look_at_intervals(Identified& found) {
  const ArmConstants& constants = found.constants;
  double most = constants.mass.plus_minus / constants.mass.value;
  for (const Estimate& gain : constants.gain) most = std::max(most, gain.plus_minus / gain.value);
  // Written so that NaN is too much.
  if (most < kUnknownMost) return;
  found.against.push_back(fmt::format(
      "The tip moved too little beside its dry friction to tell masses and forces better than to "
      "{:.0f} %. Take more time (--seconds), or a heavier known mass.",
      100 * most));
}

/// Measures what does not hang on the motion: how reports come, and the firmware's watchdog.
void look_at_link(BenchArm& bench, const scene::ArmFile& file, const ArmConstants& bare,
                  double force_most, const std::atomic<bool>& stop, Identified& found) {
  constexpr double kListened = 2, kRested = 1;  // s
  bench.watch({});
  found.reports = time_reports(bench, kListened, stop);
  found.encoders.rest = encoders_at_rest(bench, kRested, stop);
  // What moves otherwise than it is understood is not pushed further; behind a cable that stretches
  // the oscillation of the link hides when the force goes off.
  if (!found.against.empty() || found.lines.stretches) return;
  // Of a force along y, what these motors make of it.
  const Eigen::Matrix3d J_T = found.moved.samples.back().G.inverse().transpose();
  const Eigen::Vector3d y_B = file.R_WB.transpose() * Eigen::Vector3d::UnitY();
  Eigen::Vector3d tau = J_T * y_B;
  for (std::size_t i = 0; i < 3; ++i) tau[static_cast<Eigen::Index>(i)] *= bare.gain[i].value;
  const double share = y_B.dot(J_T.inverse() * tau);
  if (!(share > 0.2)) return;
  found.watchdog = watchdog_time(bench,
                                 {.named = 1e-9 * static_cast<double>(file.limits.watchdog_ns),
                                  .mass = bare.mass.value / share,
                                  .coulomb = bare.coulomb.value / share,
                                  .delay = bare.delay.value,
                                  .workspace = file.workspace,
                                  .force_most = force_most},
                                 file.limits.soft_start, stop);
}

/// Returns whether a spring to a place holds the tip, found in a fit with one.
bool is_held(const PerMass& held, double mass) {
  const double spring = held.theta[PerMass::kStiffness] * mass;
  const double error = std::sqrt(held.covariance(PerMass::kStiffness, PerMass::kStiffness)) * mass;
  return std::abs(spring) > kSpringLeast && std::abs(spring) > 5 * error;
}

/// Looks in what the fit leaves for what it does not know of. A hand, which `held` tells of, looks
/// like joints that stick, and those are not looked for then.
void look_closer(Identified& found, bool held) {
  const FittedMotion motion = found.fitted();
  found.friction = friction_directions(motion, found.constants.mass);
  if (!found.against.empty() && !held) {
    const RubbingJoints rubbing = rubbing_joints(motion, found.constants.mass.value);
    const int most = rubbing.most();
    const Estimate& coulomb = rubbing.coulomb[static_cast<std::size_t>(most)];
    if (rubbing.seen) {
      found.against.insert(
          found.against.begin(),
          fmt::format("Joint {} sticks: {:.2g} +- {:.1g} N m of dry friction are its own, beside "
                      "what all axes of the tip have. Its cable, bearing or motor rubs.",
                      most + 1, coulomb.value, coulomb.plus_minus));
    }
  }
  if (found.lines.stretches) return;
  found.saturation = saturations(motion);
  for (std::size_t i = 0; i < 3; ++i) {
    const Saturation& one = found.saturation[i];
    if (!one.seen) continue;
    found.against.insert(
        found.against.begin(),
        fmt::format("Motor {} gives no more than {:.3g} +- {:.1g} N m at the joint, and was asked "
                    "for up to {:.3g}: its amplifier saturates, or current_max of the arm file is "
                    "more than it gives.",
                    i + 1, one.most.value, one.most.plus_minus, one.asked));
  }
}

}  // namespace

std::vector<std::string> speaks_against(const PerMass& fit, const PerMass& held, double mass,
                                        bool stretches) {
  std::vector<std::string> against;
  if (is_held(held, mass)) {
    against.push_back(fmt::format(
        "Something holds the tip like a spring of {:.0f} N/m: let go of the grip, and keep cables "
        "off the arm.",
        held.theta[PerMass::kStiffness] * mass));
  }
  const double times = fit.residual / fit.noise;
  const double unexplained = std::sqrt(std::max(0.0, 1 - fit.explained));
  if (times > (stretches ? kCableResidualMost : kResidualMost) &&
      unexplained > (stretches ? kCableUnexplainedMost : kUnexplainedMost)) {
    against.push_back(fmt::format(
        "The motion is not that of a rigid arm with dry and viscous friction: the fit leaves "
        "{:.1f} % of the acceleration, {:.1f} times what the encoders' steps do. Cables that "
        "stretch, play, a joint that sticks, a hand, or missed edges do that.",
        100 * unexplained, times));
  }
  const double all = static_cast<double>(fit.windows + fit.left_out);
  if (static_cast<double>(fit.left_out) > kLeftOutMost * all) {
    against.push_back(fmt::format(
        "The tip stood still for {:.0f} % of the motion: its friction is too high for the force "
        "that is allowed.",
        100 * static_cast<double>(fit.left_out) / all));
  }
  return against;
}

driver::Result<void> check_forces(const scene::ArmFile& file, const IdentifyOptions& options) {
  if (!(options.force_most >= kForceLeast)) {
    return driver::Error{fmt::format(
        "The largest force must be {:g} N at least: less moves no arm that we know.", kForceLeast)};
  }
  if (!(options.force_most <= file.limits.force_max)) {
    return driver::Error{
        fmt::format("A largest force of {:g} N is more than the {:g} N that the arm file allows "
                    "(gate.force_max).",
                    options.force_most, file.limits.force_max)};
  }
  // Beside what carries the mass something must be left that moves it.
  const double carried = kCarriedMost * options.force_most / kStandardGravity;
  const double most = std::min(kKnownMassMost, carried);
  if (!(options.known_mass >= 0 && options.known_mass <= most)) {
    return driver::Error{
        fmt::format("The known mass must be {:.2g} kg at most: with no more than {:g} N its weight "
                    "has to be carried, and shaken.",
                    most, options.force_most)};
  }
  return {};
}

driver::Result<Identified> identify(const OpenBench& open, const scene::ArmFile& file,
                                    const IdentifyOptions& options, const std::atomic<bool>& stop) {
  if (file.is<driver::ToldArm>()) {
    return driver::Error{
        "Identifying needs an arm whose motors turn its joints by currents (PHANTOM, "
        "WoodenHaptics, Polhem, Falcon). What an arm behind its vendor's software does with a "
        "force is not told."};
  }
  if (!(options.seconds >= 10 && options.seconds <= 600)) {
    return driver::Error{"Each motion takes from 10 to 600 s."};
  }
  if (auto right = check_forces(file, options); !right) return right.error();
  Identified found;
  Eigen::Vector3d down_B(0, 0, -1), share(1, 1, 1);
  bool held_tip = false;
  for (const bool loaded : {false, true}) {
    if (loaded && options.known_mass == 0) break;
    auto bench = open(loaded);
    if (!bench) return bench.error();
    if (!loaded) (*bench)->watch(options.watch);
    const auto motion = record_motion(**bench, file,
                                      {.seconds = options.seconds,
                                       .lead = options.lead,
                                       .added_mass = loaded ? options.known_mass : 0,
                                       .force_most = options.force_most,
                                       .seed = options.seed + (loaded ? 1 : 0),
                                       .share = share},
                                      stop);
    if (!motion) return motion.error();
    share = motion->share;
    auto fit = fit_motion(*motion, false);
    if (!fit) return fit.error();
    if (!loaded) found.encoders.step = encoder_steps(*motion);
    if (!loaded) found.spectrum = line_spectrum(*motion);
    if (!loaded) found.lines = fit_cables(found.spectrum, *fit, motion->dt);
    const double blamed = options.cables ? 0 : found.lines.better;
    if (!options.cables) found.lines = {};
    driver::Result<ArmMotion> links = *motion;
    // A mass on the tip changes neither motors nor cables.
    if (found.lines.stretches) {
      auto behind = behind_cables(*motion, file, found.lines, !loaded, *fit);
      if (!behind) return behind.error();
      links = std::move(behind).value();
    }
    const auto held = fit_motion(*links, true);
    if (!held) return held.error();
    down_B = motion->down_B;
    if (loaded) {
      found.loaded = *fit;
    } else {
      found.bare = *fit;
      found.moved = std::move(links).value();
      if (found.lines.stretches) {
        found.moved_ahead = found.lines.elastic.theta[TwoMass::kDelay] - kHeldBack * motion->dt;
      }
    }
    const auto alone = arm_constants(*fit, down_B, {}, 0);
    if (!alone) return alone.error();
    held_tip = held_tip || is_held(*held, alone->mass.value);
    for (std::string& sentence :
         speaks_against(*fit, *held, alone->mass.value, found.lines.stretches)) {
      found.against.push_back((loaded ? "With the known mass: " : "") + sentence);
    }
    if (!loaded && blamed > kCablesBlamed) {
      found.against.push_back(fmt::format(
          "Above {:g} Hz the arm does not move like a rigid one; with a mass behind each "
          "cable it is understood better (by {:.0f} of the Bayesian information). Its "
          "cables stretch, which were not looked for.",
          LineForces::kLowest, blamed));
    }
    if (!loaded && options.link) {
      look_at_link(**bench, file, *alone, options.force_most, stop, found);
    }
  }
  auto constants = arm_constants(found.bare, down_B, found.loaded, options.known_mass);
  if (!constants) return constants.error();
  found.constants = *constants;
  constexpr double kMisfitMost = 50;
  if (found.loaded && found.lines.stretches) {
    const auto apart = arm_constants(with_method(found.bare), down_B, with_method(*found.loaded),
                                     options.known_mass);
    found.constants.misfit = apart ? apart->misfit : HUGE_VAL;
  }
  if (found.constants.misfit > kMisfitMost) {
    found.against.push_back(fmt::format(
        "The two motions are not those of one arm with {:g} kg on it (chi^2 {:.0f} per degree of "
        "freedom): weigh the mass, and fix it so that it does not swing.",
        options.known_mass, found.constants.misfit));
  }
  widen(found.constants);
  if (found.lines.stretches) put_cables(found);
  look_at_intervals(found);
  look_closer(found, held_tip);
  return found;
}

}  // namespace thimble::app
