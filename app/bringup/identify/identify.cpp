#include "bringup/identify/identify.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bringup/identify/record_motion.h"

namespace thimble::app {
namespace {

// What the smoothing of velocities' signs and torques that are held for a tick cost beyond the
// statistics [chosen: so that intervals hold 95 % of the truths of hidden arms, identify_test].
constexpr double kMethodShare = 0.0004;   // of mass and Coulomb friction
constexpr double kMethodViscous = 0.003;  // N s/m for each N of Coulomb friction
constexpr double kMethodGain = 0.0002;    // of a gain
constexpr double kMethodDelay = 2e-6;     // s
// A right arm leaves 1 to 4 times what its encoders' steps do, or below 1 % of its acceleration
// where it is light; one that is another leaves more of both.
constexpr double kResidualMost = 4;
constexpr double kUnexplainedMost = 0.02;
// Springs below this are not told from an axis that sticks now and then.
constexpr double kSpringLeast = 10;  // N/m
// Of the pieces of motion, how many may be left out because an axis stood.
constexpr double kLeftOutMost = 0.75;

void widen(Estimate& estimate, double method) {
  estimate.plus_minus = std::hypot(estimate.plus_minus, kNormal95 * method);
}

void widen(ArmConstants& constants) {
  widen(constants.mass, kMethodShare * constants.mass.value);
  widen(constants.coulomb, kMethodShare * constants.coulomb.value);
  widen(constants.viscous, kMethodViscous * constants.coulomb.value);
  for (Estimate& gain : constants.gain) widen(gain, kMethodGain * gain.value);
  widen(constants.delay, kMethodDelay);
}

std::string line(const char* name, const Estimate& estimate, double scale, const char* unit) {
  return fmt::format("  {:<22} {:>10.5g} +- {:<9.2g} {}\n", name, scale * estimate.value,
                     scale * estimate.plus_minus, unit);
}

}  // namespace

std::vector<std::string> speaks_against(const PerMass& fit, const PerMass& held, double mass) {
  std::vector<std::string> against;
  const double spring = held.theta[PerMass::kStiffness] * mass;
  const double error = std::sqrt(held.covariance(PerMass::kStiffness, PerMass::kStiffness)) * mass;
  if (std::abs(spring) > kSpringLeast && std::abs(spring) > 5 * error) {
    against.push_back(fmt::format(
        "Something holds the tip like a spring of {:.0f} N/m: let go of the grip, and keep cables "
        "off the arm.",
        spring));
  }
  const double times = fit.residual / fit.noise;
  const double unexplained = std::sqrt(std::max(0.0, 1 - fit.explained));
  if (times > kResidualMost && unexplained > kUnexplainedMost) {
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

driver::Result<Identified> identify(const OpenBench& open, const scene::ArmFile& file,
                                    const IdentifyOptions& options, const std::atomic<bool>& stop) {
  if (file.is<driver::DeltaArm>() || file.is<driver::ToldArm>()) {
    return driver::Error{
        "Identifying needs an arm whose motors turn its joints by currents: a serial arm or a "
        "linkage (PHANTOM, WoodenHaptics, Polhem). For a Falcon, or an arm behind its vendor's "
        "software, there is none yet."};
  }
  if (!(options.seconds >= 10 && options.seconds <= 600)) {
    return driver::Error{"Each motion takes from 10 to 600 s."};
  }
  if (!(options.known_mass >= 0 && options.known_mass <= 0.06)) {
    return driver::Error{
        "The known mass must be 0.06 kg at most: its weight has to be carried with less than 1 N."};
  }
  Identified found;
  Eigen::Vector3d down_B(0, 0, -1);
  for (const bool loaded : {false, true}) {
    if (loaded && options.known_mass == 0) break;
    auto bench = open(loaded);
    if (!bench) return bench.error();
    if (!loaded) (*bench)->watch(options.watch);
    const auto motion = record_motion(**bench, file,
                                      {.seconds = options.seconds,
                                       .lead = options.lead,
                                       .added_mass = loaded ? options.known_mass : 0,
                                       .seed = options.seed + (loaded ? 1 : 0)},
                                      stop);
    if (!motion) return motion.error();
    const auto fit = fit_motion(*motion, false), held = fit_motion(*motion, true);
    if (!fit) return fit.error();
    if (!held) return held.error();
    down_B = motion->down_B;
    if (loaded) {
      found.loaded = *fit;
    } else {
      found.bare = *fit;
    }
    const auto alone = arm_constants(*fit, down_B, {}, 0);
    if (!alone) return alone.error();
    for (std::string& sentence : speaks_against(*fit, *held, alone->mass.value)) {
      found.against.push_back((loaded ? "With the known mass: " : "") + sentence);
    }
  }
  auto constants = arm_constants(found.bare, down_B, found.loaded, options.known_mass);
  if (!constants) return constants.error();
  found.constants = *constants;
  constexpr double kMisfitMost = 50;
  if (found.constants.misfit > kMisfitMost) {
    found.against.push_back(fmt::format(
        "The two motions are not those of one arm with {:g} kg on it (chi^2 {:.0f} per degree of "
        "freedom): weigh the mass, and fix it so that it does not swing.",
        options.known_mass, found.constants.misfit));
  }
  widen(found.constants);
  return found;
}

std::string constants_table(const Identified& identified) {
  const ArmConstants& found = identified.constants;
  std::string text = "Constants, each with its 95 % interval:\n";
  text += line("mass at the tip", found.mass, 1e3, "g");
  text += line("viscous friction", found.viscous, 1, "N s/m");
  text += line("Coulomb friction", found.coulomb, 1e3, "mN per axis");
  text += line("weight", found.weight, 1e3, "mN");
  for (std::size_t i = 0; i < 3; ++i) {
    text += line(fmt::format("gain of motor {}", i + 1).c_str(), found.gain[i], 1,
                 "of the arm file's torque constant");
  }
  text += line("delay, force to motion", found.delay, 1e3, "ms");
  const PerMass& fit = identified.bare;
  text += fmt::format(
      "Fitted to {} pieces of motion ({} left out, in which an axis stood); {:.3f} % of the "
      "acceleration is explained, what is left is {:.1f} times the encoders' steps.\n",
      fit.windows, fit.left_out, 100 * fit.explained, fit.residual / fit.noise);
  text += found.absolute
              ? "Mass and forces were measured with the known mass.\n"
              : "Motion alone shows no mass without a force: the torque constants of the arm file "
                "were taken to be right on average. All but the delay is as wrong as they are; a "
                "known mass on the tip (--known-mass) measures them.\n";
  text +=
      "Not measured: cable stretch and play, cogging, how the mass changes over the "
      "workspace.\n";
  return text;
}

}  // namespace thimble::app
