#include "bringup/identify/cables/behind_cables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bringup/identify/line_forces.h"
#include "math/elementary.h"

namespace thimble::bringup {
namespace {

// Errors of a motion behind cables beyond its statistics [chosen likewise, with soft arms 1 to 20,
// 101 to 120 and 6000 to 6019 of identify_cables_test].
constexpr double kCableMass = 0.01;       // of mass; for a motor, of the link's inertia
constexpr double kCableFriction = 0.007;  // N of friction and weight for each N of Coulomb friction
constexpr double kCableViscous = 0.06;    // N s/m for each N of Coulomb friction
constexpr double kCableGain = 0.0065;     // of a gain
constexpr double kCableDelay = 2e-5;      // s
constexpr double kCableDamping = 0.05;    // of a cable's damping, which dry friction affects
constexpr double kCableLines = 2;         // times the lines' noise
// Remaining share of these errors if motors and cables are simulated to the encoders' steps and the
// motors have no friction, which hides some of them [chosen: identify_cables_test,
// identify_backlash_test].
constexpr double kShareIfSimulated = 0.4;
// Lines fit to 1 to 1.5; the rest is due to nonlinear geometry and friction.
constexpr double kLinesMisfitMax = 10;
// Max. half-width of an interval over the value, of a cable, and of a motor's inertia. If the
// latter is small compared with its link's, little is known of it, and it matters little.
constexpr double kCableUnknownMax = 0.6;
constexpr double kMotorUnknownMax = 1;

}  // namespace

driver::Result<ArmMotion> behind_cables(const ArmMotion& motion, const scene::ArmFile& file,
                                        CableFit& lines, bool refine, MassNormalisedFit& fit) {
  constexpr int kRounds = 2;
  // Errors of the method in addition to the statistics [chosen like those above]: times a
  // deviation, and of the link's inertia.
  constexpr double kTrust = 3, kShareError = 0.02;
  const LineSpectrum spectrum = refine ? line_spectrum(motion) : LineSpectrum{};
  for (int round = 0;; ++round) {
    auto links = motion_of_links(motion, lines, file);
    if (!links) return links.error();
    const bool last = !refine || round == kRounds;
    auto seen = fit_motion(*links, false, !last);
    if (!seen) return seen.error();
    fit = *seen;
    fit.delay.value += lines.elastic.theta[TwoMass::kDelay] - kDelayTicks * motion.dt;
    if (last) return links;
    SlowPart slow;
    slow.gain = fit.theta.segment<3>(MassNormalisedFit::kGain);
    for (int i = 0; i < 3; ++i) {
      const int g = TwoMass::kGain + i, J = TwoMass::kInertia + i;
      slow.ratio[i] = std::max(0.0, lines.elastic.theta[J] / lines.elastic.theta[g] +
                                        fit.theta[MassNormalisedFit::kInertia + i] / slow.gain[i]);
      slow.gain_error[i] = kTrust * std::sqrt(fit.covariance(i, i));
      const double error = kTrust * std::sqrt(fit.covariance(MassNormalisedFit::kInertia + i,
                                                             MassNormalisedFit::kInertia + i));
      slow.ratio_error[i] = math::hypot(error, kShareError * spectrum.JTJ(i, i)) / slow.gain[i];
    }
    slow.delay = fit.delay.value;
    slow.delay_error = kTrust * std::max(2e-6, fit.delay.plus_minus / kNormal95);
    refine_cables(lines, spectrum, slow, motion.dt);
  }
}

void put_cables(Identified& found) {
  ArmConstants& constants = found.constants;
  const bool clear = found.play.fits_to_steps() && !found.play.friction.seen;
  const double share = clear ? kShareIfSimulated : 1;
  const double mass = share * kCableMass * constants.mass.value;
  const double friction = share * constants.coulomb.value;
  widen(constants.mass, mass);
  widen(constants.coulomb, kCableFriction * friction);
  widen(constants.viscous, kCableViscous * friction);
  widen(constants.weight, kCableFriction * friction);
  widen(constants.delay, share * kCableDelay);
  for (Estimate& gain : constants.gain) widen(gain, share * kCableGain * gain.value);
  constants.cables = cable_constants(found.lines, constants.gain);
  for (std::size_t i = 0; i < 3; ++i) {
    CableConstants& cable = (*constants.cables)[i];
    // An excess in a motor's inertia is missing in the link's.
    const auto k = static_cast<Eigen::Index>(i);
    widen(cable.inertia, mass * found.lines.JTJ(k, k));
    for (Estimate* estimate :
         {&cable.stiffness, &cable.damping, &cable.antiresonance, &cable.resonance}) {
      estimate->plus_minus *= kCableLines;
    }
    widen(cable.damping, share * kCableDamping * cable.damping.value);
    if (found.play.seen && found.play.shows[i]) cable.play = found.play.width[i];
    const RotorFriction& rotors = found.play.friction;
    if (!rotors.seen) continue;
    if (rotors.shows_viscous[i]) cable.viscous = by_gain(rotors.viscous[i], constants.gain[i]);
    if (rotors.shows_coulomb[i]) cable.coulomb = by_gain(rotors.coulomb[i], constants.gain[i]);
  }
  if (found.lines.elastic.misfit > kLinesMisfitMax) {
    found.against.push_back(
        fmt::format("Above {:g} Hz the motion fits neither a rigid arm nor an arm with a mass "
                    "behind each cable (chi^2 {:.0f} per degree of freedom). Possible causes: "
                    "backlash, a second resonance or a hand.",
                    LineForces::kLowest, found.lines.elastic.misfit));
  }
  const auto hz = [&](std::size_t i) { return (*constants.cables)[i].antiresonance.value; };
  const std::size_t softest =
      std::min<std::size_t>({0, 1, 2}, [&](auto a, auto b) { return hz(a) < hz(b); });
  // Below the lowest line the motion may fit well with a stiffness that is a quarter off, because a
  // link on a very soft cable moves like a lighter one.
  if (hz(softest) < LineForces::kLowest) {
    found.against.insert(
        found.against.begin(),
        fmt::format("The link of joint {} oscillates on its cable at {:.0f} Hz, but cables are "
                    "identified from {:g} Hz on. This cable may be too soft to be identified.",
                    softest + 1, hz(softest), LineForces::kLowest));
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const CableConstants& cable = (*constants.cables)[i];
    if (cable.inertia.plus_minus < kMotorUnknownMax * cable.inertia.value &&
        cable.stiffness.plus_minus < kCableUnknownMax * cable.stiffness.value) {
      continue;
    }
    found.against.push_back(
        fmt::format("The cable of joint {} stretches (its link oscillates on it at {:.0f} Hz), but "
                    "the constants of motor and cable are too uncertain to be written: {:.2g} +- "
                    "{:.2g} kg m^2, {:.3g} +- {:.2g} N m/rad. Record for longer (--duration).",
                    i + 1, cable.antiresonance.value, cable.inertia.value, cable.inertia.plus_minus,
                    cable.stiffness.value, cable.stiffness.plus_minus));
  }
}

MassNormalisedFit with_method(const MassNormalisedFit& fit) {
  MassNormalisedFit wider = fit;
  const auto add = [&wider](int k, double error) { wider.covariance(k, k) += error * error; };
  const double coulomb = fit.theta[MassNormalisedFit::kCoulomb];
  for (int i = 0; i < 3; ++i) {
    add(MassNormalisedFit::kGain + i, kCableGain * fit.theta[MassNormalisedFit::kGain + i]);
    add(MassNormalisedFit::kWeight + i, kCableFriction * coulomb);
  }
  add(MassNormalisedFit::kViscous, kCableViscous * coulomb);
  add(MassNormalisedFit::kCoulomb, kCableFriction * coulomb);
  return wider;
}

}  // namespace thimble::bringup
