#include "bringup/identify/unidentified_parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bringup/identify/line_forces.h"
#include "text/counted.h"

namespace thimble::bringup {
namespace {

using Sentences = std::vector<std::string>;

void of_constants(const ArmConstants& found, Sentences& all) {
  if (!found.absolute) {
    all.emplace_back(
        "Scale: motion shows only ratios of mass and force, so the mean torque constant of the arm "
        "file was assumed to be correct. Its error affects every constant except the delay. A "
        "known mass on the tip (--known-mass) measures it.");
  }
  if (found.viscous.holds(0)) {
    all.push_back(fmt::format("Viscous friction: hidden by dry friction; below {:.3g} N s/m.",
                              std::max(0.0, found.viscous.value + found.viscous.plus_minus)));
  }
  if (found.weight.holds(0)) {
    all.push_back(fmt::format("Weight: none detected; below {:.2g} mN.",
                              1e3 * (found.weight.value + found.weight.plus_minus)));
  }
}

void of_cables(const Identified& identified, Sentences& all) {
  const CableFit& lines = identified.lines;
  if (lines.noise.empty()) {
    all.emplace_back("Cables that stretch: not searched.");
  } else if (!lines.stretches) {
    const Eigen::Vector3d from =
        lines.unseen_from.cwiseMin(Eigen::Vector3d::Constant(LineForces::kHighest));
    all.push_back(fmt::format(
        "Cables that stretch: no compliance detected; a link that oscillates on its cable below "
        "{:.0f}, {:.0f}, {:.0f} Hz (joints 1, 2, 3) would have been detected.",
        from[0], from[1], from[2]));
  } else if (identified.constants.cables) {
    for (std::size_t i = 0; i < 3; ++i) {
      const CableConstants& cable = (*identified.constants.cables)[i];
      if (CableConstants::sees(cable.resonance)) continue;
      all.push_back(fmt::format(
          "Resonance of motor and link {}: not measured to 5 % below {:g} Hz; computed from "
          "inertia and stiffness: {:.0f} +- {:.0f} Hz.",
          i + 1, LineForces::kHighest, cable.resonance.value, cable.resonance.plus_minus));
    }
  }
}

void of_backlash(const Identified& identified, Sentences& all) {
  const BacklashResult& play = identified.play;
  if (!play.searched) {
    all.emplace_back(
        "Backlash: not searched. It shows when motors turn freely, apart from their links, and is "
        "searched only if cables stretch.");
    return;
  }
  if (!play.fits) {
    all.push_back(fmt::format(
        "Backlash: not identified. The motion of the motors fits neither with nor without backlash "
        "within the encoder steps (chi^2 {:.1f} and {:.1f} per degree of freedom).",
        play.with.misfit, play.without.misfit));
    return;
  }
  std::string none;
  for (std::size_t i = 0; i < 3; ++i) {
    if (play.seen && play.shows[i]) continue;
    none += fmt::format("{}{:.2g} mrad (joint {})", none.empty() ? "" : ", ",
                        1e3 * (play.width[i].value + play.width[i].plus_minus), i + 1);
  }
  if (!none.empty()) all.push_back("Backlash: none detected above " + none + ", whole width.");
}

/// Detection limits of one friction of the motors' side, joint by joint.
std::string unseen_friction(const Identified& identified, const std::array<Estimate, 3>& friction,
                            const std::array<bool, 3>& shows, const char* unit) {
  std::string none;
  for (std::size_t i = 0; i < 3; ++i) {
    if (identified.play.friction.seen && shows[i]) continue;
    const Estimate is = by_gain(friction[i], identified.constants.gain[i]);
    none += fmt::format("{}{:.2g} {} (joint {})", none.empty() ? "" : ", ",
                        1e3 * std::max(0.0, is.value + is.plus_minus), unit, i + 1);
  }
  return none;
}

/// Detection limits of one friction of a rigid arm's joints.
std::string unseen_friction(const Identified& identified, const std::array<double, 3>& below,
                            const char* unit) {
  std::string none;
  for (std::size_t i = 0; i < 3; ++i) {
    none += fmt::format("{}{:.2g} {} (joint {})", none.empty() ? "" : ", ",
                        1e3 * identified.constants.gain[i].value * below[i], unit, i + 1);
  }
  return none;
}

void of_joint_friction(const Identified& identified, Sentences& all) {
  const JointFrictionFit& rubbing = identified.rubbing;
  if (!rubbing.searched) {
    all.emplace_back(
        "Friction of single joints: not searched; only the friction along the axes of the tip is "
        "reported.");
    return;
  }
  if (rubbing.seen) return;
  all.push_back("Dry friction of joints in addition to that of the tip: none detected above " +
                unseen_friction(identified, rubbing.coulomb_below, "mN m") + ".");
  all.push_back("Viscous friction of joints in addition to that of the tip: none detected above " +
                unseen_friction(identified, rubbing.viscous_below, "mN m s/rad") + ".");
}

void of_rotor_friction(const Identified& identified, Sentences& all) {
  const BacklashResult& play = identified.play;
  if (!identified.lines.stretches && !play.searched) return of_joint_friction(identified, all);
  if (!play.searched) {
    all.emplace_back(
        "Friction of single joints: not searched; only the friction along the axes of the tip is "
        "reported.");
    return;
  }
  if (!play.fits || !play.friction.fits) {
    all.emplace_back(
        "Friction of single joints: not identified; the motion of the motors does not fit within "
        "the encoder steps.");
    return;
  }
  const RotorFriction& friction = play.friction;
  const std::string dry =
      unseen_friction(identified, friction.coulomb, friction.shows_coulomb, "mN m");
  const std::string viscous =
      unseen_friction(identified, friction.viscous, friction.shows_viscous, "mN m s/rad");
  if (!dry.empty()) {
    all.push_back("Dry friction of joints in addition to that of the tip: none detected above " +
                  dry + ".");
  }
  if (!viscous.empty()) {
    all.push_back(
        "Viscous friction of joints in addition to that of the tip: none detected above " +
        viscous + ".");
  }
  if (friction.seen) {
    all.emplace_back(
        "Dry friction of a joint by direction: not identified. Half of the difference is a "
        "constant torque, which cannot be distinguished from weight.");
  }
}

void of_friction(const FrictionDirections& friction, int motors, Sentences& all) {
  if (motors < 3) {
    all.emplace_back(
        "Dry friction that differs between axes or directions: searched only with three motors.");
    return;
  }
  if (!friction.axes_differ && !friction.directions_differ) {
    double limit = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      limit = std::max({limit, friction.mean[i].plus_minus, friction.uneven[i].plus_minus});
    }
    all.push_back(fmt::format(
        "Dry friction that differs between axes or directions: none detected above {:.2g} mN.",
        1e3 * limit));
  }
  all.emplace_back(
      "Dry friction up and down: a difference cannot be distinguished from weight, in motion or at "
      "rest, and is included in the weight.");
}

void of_saturation(const Identified& identified, Sentences& all) {
  if (identified.lines.stretches) {
    all.emplace_back("Saturation of the amplifiers: not searched because the cables stretch.");
    return;
  }
  std::string none, blind;
  for (std::size_t i = 0; i < static_cast<std::size_t>(identified.moved.motors); ++i) {
    const Saturation& one = identified.saturation[i];
    if (one.seen) continue;
    std::string& text = one.searched ? none : blind;
    text += fmt::format("{}{:.2g} N m (joint {})", text.empty() ? "" : ", ", one.asked, i + 1);
  }
  if (!none.empty()) {
    all.push_back("Saturation of the amplifiers: none detected up to " + none +
                  ", the highest torque requested.");
  }
  if (!blind.empty()) {
    all.push_back("Saturation of the amplifiers: not searched; the highest torque requested was " +
                  blind + ", too little above friction.");
  }
}

void of_encoders(const Encoders& encoders, std::size_t motors, Sentences& all) {
  for (std::size_t i = 0; i < motors; ++i) {
    if (encoders.step[i].counts == 0) {
      all.push_back(
          fmt::format("Step of encoder {}: the encoder did not count step by step, so its smallest "
                      "step is unknown.",
                      i + 1));
    }
  }
  all.emplace_back(
      "Counts per turn: taken from the arm file. Only the smallest difference between two reports "
      "was measured, in counts.");
  if (!encoders.rest) {
    all.emplace_back("Noise of the encoders: not requested.");
    return;
  }
  for (std::size_t i = 0; i < motors; ++i) {
    if (encoders.rest->at_rest[i]) continue;
    all.push_back(
        fmt::format("Noise of encoder {}: not measured; the joint did not come to rest, so noise "
                    "cannot be distinguished from motion.",
                    i + 1));
  }
}

/// Detection limits of the waves that were not seen, motor by motor.
std::string undetected_cogging(const Identified& identified, bool cogging,
                               double TorqueVariation::*below) {
  const MotorCogging& waves = identified.waves;
  std::string text;
  for (std::size_t i = 0; i < 3; ++i) {
    const TorqueVariation& one = (cogging ? waves.cogging : waves.ripple)[i];
    if (one.seen || one.*below == 0) continue;
    const double scale = cogging ? 1e3 * identified.constants.gain[i].value /
                                       waves.ratio[static_cast<Eigen::Index>(i)]
                                 : 100;
    text += fmt::format("{}{:.2g} {} (motor {})", text.empty() ? "" : ", ", scale * one.*below,
                        cogging ? "mN m" : "%", i + 1);
  }
  return text;
}

void of_cogging(const Identified& identified, Sentences& all) {
  const MotorCogging& waves = identified.waves;
  if (!waves.searched) {
    all.push_back("Cogging and ripple of the motors: " + waves.not_done);
    return;
  }
  if (waves.seen() && !waves.is_reported()) {
    std::string others;
    for (const double other : waves.rivals) others += fmt::format(", {:g}", other);
    all.push_back(fmt::format(
        "Cogging and ripple of the motors: detected and removed from the motion, but the number of "
        "periods per turn is ambiguous: {:g}{} fit about equally well. Record for longer "
        "(--duration), or set drive_train: {{periods_per_turn: ...}} in the arm file.",
        waves.periods, others));
    return;
  }
  for (const bool cogging : {true, false}) {
    const std::string few = undetected_cogging(identified, cogging, &TorqueVariation::below);
    const std::string any = undetected_cogging(identified, cogging, &TorqueVariation::below_of_any);
    if (any.empty()) continue;
    all.push_back(fmt::format(
        "{}: none detected; {}{} with {:g} to {:g} periods per turn would have been detected.",
        cogging ? "Cogging of the motors" : "Ripple of the motors",
        few.empty() || few == any ? "" : fmt::format("{} with up to {:g}, ", few, kFewPeriods), any,
        waves.min_periods, waves.max_periods));
  }
}

std::string watchdog_text(const WatchdogPush& seen) {
  switch (seen.end) {
    case WatchdogEnd::kTooLong:
      return fmt::format(
          "not measured; a free tip would move farther than {:.0f} mm before it acts. `thimble "
          "feel-check` measures it with a hand on the grip.",
          1e3 * kWatchdogWayMax);
    case WatchdogEnd::kNoRoom:
      return "not measured; the tip was too close to a side of the workspace.";
    case WatchdogEnd::kTooMuch:
      return fmt::format(
          "not measured; the dry friction needs a push of {:.2f} N, which exceeds the limit.",
          seen.force);
    case WatchdogEnd::kAnswersOnly:
      return "not measured; the arm sends reports only on request, so its motion without messages "
             "cannot be observed.";
    case WatchdogEnd::kHeld:
      return fmt::format("not measured; the tip did not move under {:.2f} N.", seen.force);
    case WatchdogEnd::kLetGo:
    case WatchdogEnd::kStillOn:
      return fmt::format(
          "not measured; the motors were still on {:.0f} ms after the last message, when the tip "
          "had moved {:.0f} mm and was released.",
          1e3 * seen.time, 1e3 * seen.way);
    case WatchdogEnd::kStopped:
    case WatchdogEnd::kSeen:
      break;
  }
  return "not measured; a fault, or a tip that left the workspace, ended the measurement.";
}

void of_link(const Identified& identified, Sentences& all) {
  if (!identified.reports) {
    all.emplace_back("Report period and jitter: not requested.");
  } else if (identified.reports->period.value == 0) {
    all.push_back(fmt::format("Report period and jitter: not measured; only {} arrived.",
                              scene::counted(identified.reports->reports, "report")));
  } else if (identified.reports->blurred) {
    all.emplace_back(
        "Report period and jitter: approximate only; reports are so irregular that a late one "
        "cannot be distinguished from a missing one.");
  }
  if (!identified.watchdog) {
    all.push_back("Watchdog of the firmware: " +
                  std::string(!identified.reports ? "not requested."
                              : !identified.against.empty()
                                  ? "not measured; an arm with a bad fit is not pushed further."
                                  : "not measured; links that oscillate on their cables hide when "
                                    "the force goes off."));
  } else if (!identified.watchdog->known()) {
    all.push_back("Watchdog of the firmware: " + watchdog_text(identified.watchdog->last));
  }
}

void of_workspace(const Identified& identified, Sentences& all) {
  const WorkspaceSweep& over = identified.over;
  if (!over.fit) {
    all.push_back(
        "Mass over the workspace: " + over.not_done +
        " The tip moved within 4 cm of one place, where the links look like a single mass.");
  } else if (!over.fit->links) {
    all.push_back(
        fmt::format("Links: none detected; over {} places of the workspace the mass along an axis "
                    "is the same within {:.2g} %.",
                    over.fit->places.size(), 100 * over.fit->max_change));
  } else {
    all.emplace_back(
        "Coupling of the links, and their moment along C: motion cannot distinguish them from mass "
        "and weight at the tip. The coupling is set to its minimum, the moment along C takes any "
        "negative weight, and the tip has the rest; all such choices move identically.");
  }
}

}  // namespace

std::vector<std::string> unidentified_parameters(const Identified& identified) {
  Sentences all;
  of_constants(identified.constants, all);
  of_cables(identified, all);
  if (identified.play.is_reported()) {
    all.emplace_back(
        "Dry friction that differs between axes or directions: not searched because of backlash or "
        "friction of the motors.");
  } else {
    of_friction(identified.friction, identified.moved.motors, all);
  }
  of_saturation(identified, all);
  of_encoders(identified.encoders, static_cast<std::size_t>(identified.moved.motors), all);
  of_link(identified, all);
  of_backlash(identified, all);
  of_rotor_friction(identified, all);
  of_cogging(identified, all);
  of_workspace(identified, all);
  return all;
}

}  // namespace thimble::bringup
