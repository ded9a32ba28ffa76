#include "bringup/identify/not_identified.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bringup/identify/line_forces.h"

namespace thimble::bringup {
namespace {

using Sentences = std::vector<std::string>;

void of_constants(const ArmConstants& found, Sentences& all) {
  if (!found.absolute) {
    all.emplace_back(
        "Scale: motion alone shows no mass without a force, so the torque constants of the arm "
        "file were taken to be right on average. All but the delay is as wrong as they are; a "
        "known mass on the tip (--known-mass) measures them.");
  }
  if (found.viscous.holds(0)) {
    all.push_back(fmt::format(
        "Viscous friction: too weak beside dry friction to be seen; below {:.3g} N s/m.",
        std::max(0.0, found.viscous.value + found.viscous.plus_minus)));
  }
  if (found.weight.holds(0)) {
    all.push_back(fmt::format("Weight: none seen; below {:.2g} mN.",
                              1e3 * (found.weight.value + found.weight.plus_minus)));
  }
}

void of_cables(const Identified& identified, Sentences& all) {
  const CableFit& lines = identified.lines;
  if (lines.noise.empty()) {
    all.emplace_back("Cables that stretch: they were not looked for.");
  } else if (!lines.stretches) {
    const Eigen::Vector3d from =
        lines.unseen_from.cwiseMin(Eigen::Vector3d::Constant(LineForces::kHighest));
    all.push_back(fmt::format(
        "Cables that stretch: no compliance was seen; a link that oscillates on its cable below "
        "{:.0f}, {:.0f}, {:.0f} Hz (joint by joint) would have been.",
        from[0], from[1], from[2]));
  } else if (identified.constants.cables) {
    for (std::size_t i = 0; i < 3; ++i) {
      const CableConstants& cable = (*identified.constants.cables)[i];
      if (CableConstants::sees(cable.resonance)) continue;
      all.push_back(fmt::format(
          "Resonance of motor and link {}: not seen to 5 % below {:g} Hz; inertia and stiffness "
          "make "
          "it {:.0f} +- {:.0f} Hz.",
          i + 1, LineForces::kHighest, cable.resonance.value, cable.resonance.plus_minus));
    }
  }
}

void of_play(const Identified& identified, Sentences& all) {
  const PlayFit& play = identified.play;
  if (!play.searched) {
    all.emplace_back(
        "Play: not looked for. It shows by the motors that turn freely in it, apart from their "
        "links, and is looked for where cables were seen to stretch.");
    return;
  }
  if (!play.fits) {
    all.push_back(fmt::format(
        "Play: not told. Neither with play nor without is the motion of the motors understood to "
        "the encoders' steps (chi^2 {:.1f} and {:.1f} per degree of freedom).",
        play.with.misfit, play.without.misfit));
    return;
  }
  std::string none;
  for (std::size_t i = 0; i < 3; ++i) {
    if (play.seen && play.shows[i]) continue;
    none += fmt::format("{}{:.2g} mrad (joint {})", none.empty() ? "" : ", ",
                        1e3 * (play.width[i].value + play.width[i].plus_minus), i + 1);
  }
  if (!none.empty()) all.push_back("Play: none seen above " + none + ", whole width.");
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

void of_rubbing(const Identified& identified, Sentences& all) {
  const RubbingJoints& rubbing = identified.rubbing;
  if (!rubbing.searched) {
    all.emplace_back(
        "Friction of single joints: not looked for; the friction along the axes of the tip is all "
        "that is told.");
    return;
  }
  if (rubbing.seen) return;
  all.push_back("Dry friction of joints beside that of the tip: none seen above " +
                unseen_friction(identified, rubbing.coulomb_below, "mN m") + ".");
  all.push_back("Viscous friction of joints beside that of the tip: none seen above " +
                unseen_friction(identified, rubbing.viscous_below, "mN m s/rad") + ".");
}

void of_rotor_friction(const Identified& identified, Sentences& all) {
  const PlayFit& play = identified.play;
  if (!identified.lines.stretches && !play.searched) return of_rubbing(identified, all);
  if (!play.searched) {
    all.emplace_back(
        "Friction of single joints: not looked for; the friction along the axes of the tip is all "
        "that is told.");
    return;
  }
  if (!play.fits || !play.friction.fits) {
    all.emplace_back(
        "Friction of single joints: not told, for the motion of the motors is not understood to "
        "the encoders' steps.");
    return;
  }
  const RotorFriction& friction = play.friction;
  const std::string dry =
      unseen_friction(identified, friction.coulomb, friction.shows_coulomb, "mN m");
  const std::string viscous =
      unseen_friction(identified, friction.viscous, friction.shows_viscous, "mN m s/rad");
  if (!dry.empty()) {
    all.push_back("Dry friction of joints beside that of the tip: none seen above " + dry + ".");
  }
  if (!viscous.empty()) {
    all.push_back("Viscous friction of joints beside that of the tip: none seen above " + viscous +
                  ".");
  }
  if (friction.seen) {
    all.emplace_back(
        "Dry friction of a joint by direction: not told. Half of what it differs by is a constant "
        "torque, which looks like weight.");
  }
}

void of_friction(const FrictionDirections& friction, Sentences& all) {
  if (!friction.axes_differ && !friction.directions_differ) {
    double most = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      most = std::max({most, friction.mean[i].plus_minus, friction.uneven[i].plus_minus});
    }
    all.push_back(fmt::format(
        "Dry friction that differs between axes or directions: none seen beyond {:.2g} mN.",
        1e3 * most));
  }
  all.emplace_back(
      "Dry friction up and down: what it differs by is the same as weight, in motion and at rest, "
      "and stands there.");
}

void of_saturation(const Identified& identified, Sentences& all) {
  if (identified.lines.stretches) {
    all.emplace_back("Saturation of the amplifiers: not looked for behind cables that stretch.");
    return;
  }
  std::string none, blind;
  for (std::size_t i = 0; i < 3; ++i) {
    const Saturation& one = identified.saturation[i];
    if (one.seen) continue;
    std::string& text = one.searched ? none : blind;
    text += fmt::format("{}{:.2g} N m (joint {})", text.empty() ? "" : ", ", one.asked, i + 1);
  }
  if (!none.empty()) {
    all.push_back("Saturation of the amplifiers: none seen up to " + none +
                  ", the most that was asked for.");
  }
  if (!blind.empty()) {
    all.push_back("Saturation of the amplifiers: up to " + blind +
                  " too little was asked for beyond friction to see it.");
  }
}

void of_encoders(const Encoders& encoders, Sentences& all) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (encoders.step[i].counts == 0) {
      all.push_back(fmt::format(
          "Step of encoder {}: it did not count step by step, so the smallest step is not known.",
          i + 1));
    }
  }
  all.emplace_back(
      "Counts of a turn: the steps of the encoders are those of the arm file; what was seen is how "
      "many of them a report differs from the next at the least.");
  if (!encoders.rest) {
    all.emplace_back("Noise of the encoders: not asked for.");
    return;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    if (encoders.rest->at_rest[i]) continue;
    all.push_back(fmt::format(
        "Noise of encoder {}: the joint did not come to rest, so noise and motion are not told "
        "apart.",
        i + 1));
  }
}

/// Detection limits of the waves that were not seen, motor by motor.
std::string unseen_waves(const Identified& identified, bool cogging, double MotorWave::*below) {
  const MotorWaves& waves = identified.waves;
  std::string text;
  for (std::size_t i = 0; i < 3; ++i) {
    const MotorWave& one = (cogging ? waves.cogging : waves.ripple)[i];
    if (one.seen || one.*below == 0) continue;
    const double scale = cogging ? 1e3 * identified.constants.gain[i].value /
                                       waves.ratio[static_cast<Eigen::Index>(i)]
                                 : 100;
    text += fmt::format("{}{:.2g} {} (motor {})", text.empty() ? "" : ", ", scale * one.*below,
                        cogging ? "mN m" : "%", i + 1);
  }
  return text;
}

void of_waves(const Identified& identified, Sentences& all) {
  const MotorWaves& waves = identified.waves;
  if (!waves.searched) {
    all.push_back("Cogging and ripple of the motors: " + waves.not_done);
    return;
  }
  if (waves.seen() && !waves.told()) {
    std::string others;
    for (const double other : waves.rivals) others += fmt::format(", {:g}", other);
    all.push_back(fmt::format(
        "Cogging and ripple of the motors: some was seen and taken off the motion, but not how "
        "many "
        "periods it has in a turn: {:g}{} explain it about as well. Take more time (--seconds), or "
        "write drive_train: {{periods_per_turn: ...}} of the motors into the arm file.",
        waves.periods, others));
    return;
  }
  for (const bool cogging : {true, false}) {
    const std::string few = unseen_waves(identified, cogging, &MotorWave::below);
    const std::string any = unseen_waves(identified, cogging, &MotorWave::below_of_any);
    if (any.empty()) continue;
    all.push_back(fmt::format(
        "{}: none seen; {}{} with any of {:g} to {:g} periods in a turn would have been.",
        cogging ? "Cogging of the motors" : "Ripple of the motors",
        few.empty() || few == any ? "" : fmt::format("{} with up to {:g}, ", few, kFewPeriods), any,
        waves.least, waves.most));
  }
}

std::string watchdog_text(const WatchdogSeen& seen) {
  switch (seen.end) {
    case WatchdogEnd::kTooLong:
      return fmt::format(
          "within its time a free tip would go farther than {:.0f} mm, so nothing "
          "was pushed. `thimble feel-check` measures it on a hand.",
          1e3 * kWatchdogWayMost);
    case WatchdogEnd::kNoRoom:
      return "a side of the workspace was too near for a push.";
    case WatchdogEnd::kTooMuch:
      return fmt::format("its dry friction needs {:.2f} N, more than is allowed.", seen.force);
    case WatchdogEnd::kAnswersOnly:
      return "the arm speaks only when spoken to, so nobody sees what it does in silence.";
    case WatchdogEnd::kHeld:
      return fmt::format("the tip did not move under {:.2f} N.", seen.force);
    case WatchdogEnd::kLetGo:
    case WatchdogEnd::kStillOn:
      return fmt::format(
          "the motors were still on {:.0f} ms after the last message, when the tip "
          "had gone {:.0f} mm and was let go.",
          1e3 * seen.time, 1e3 * seen.way);
    case WatchdogEnd::kStopped:
    case WatchdogEnd::kSeen:
      break;
  }
  return "a fault, or a tip that left the workspace, ended it.";
}

void of_link(const Identified& identified, Sentences& all) {
  if (!identified.reports) {
    all.emplace_back("Report period and jitter: not asked for.");
  } else if (identified.reports->period.value == 0) {
    all.push_back(fmt::format("Report period and jitter: only {} reports came in the time.",
                              identified.reports->reports));
  } else if (identified.reports->blurred) {
    all.emplace_back(
        "Report period and jitter: reports come so unevenly that a late one and a missing one "
        "cannot be told apart; both figures are rough.");
  }
  if (!identified.watchdog) {
    all.push_back("Watchdog of the firmware: " +
                  std::string(!identified.reports ? "not asked for."
                              : !identified.against.empty()
                                  ? "an arm whose fit is bad is not pushed further."
                                  : "behind cables that stretch the oscillation of the links hides "
                                    "when the force goes off."));
  } else if (!identified.watchdog->known()) {
    all.push_back("Watchdog of the firmware: " + watchdog_text(identified.watchdog->last));
  }
}

void of_workspace(const Identified& identified, Sentences& all) {
  const OverPlaces& over = identified.over;
  if (!over.fit) {
    all.push_back("Mass over the workspace: " + over.not_done +
                  " The tip moved in one place, within 4 cm; links whose share changes with the "
                  "pose look like one mass there.");
  } else if (!over.fit->links) {
    all.push_back(fmt::format(
        "Links: none seen; over {} places of the workspace the mass along an axis is the same "
        "within {:.2g} %.",
        over.fit->places.size(), 100 * over.fit->change_most));
  } else {
    all.emplace_back(
        "Coupling of the links, and their moment along C: motion does not tell them from mass and "
        "weight at the tip. Coupling is the least that links can have, moment along C what weighs "
        "less than nothing, and the tip has the rest; every such choice moves alike.");
  }
}

}  // namespace

std::vector<std::string> not_identified(const Identified& identified) {
  Sentences all;
  of_constants(identified.constants, all);
  of_cables(identified, all);
  if (identified.play.told()) {
    all.emplace_back(
        "Dry friction that differs between axes or directions: not looked for behind play or "
        "motors that rub.");
  } else {
    of_friction(identified.friction, all);
  }
  of_saturation(identified, all);
  of_encoders(identified.encoders, all);
  of_link(identified, all);
  of_play(identified, all);
  of_rotor_friction(identified, all);
  of_waves(identified, all);
  of_workspace(identified, all);
  return all;
}

}  // namespace thimble::bringup
