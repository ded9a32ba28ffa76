// Friction of single joints, on the motor's side of cables that stretch. It is found in addition to
// the friction of the tip, with intervals, and not reported where there is none.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>

#include "bringup/identify/constants_table.h"
#include "bringup/identify/output/identified_file.h"
#include "bringup/identify/unidentified_parameters.h"
#include "support/identify/cabled_arm.h"
#include "support/identify/identified_arm.h"
#include "support/identify/recorded_motion.h"
#include "support/long_form.h"

namespace thimble::bringup {
namespace {

using support::cabled_arm;
using support::HiddenArm;
using support::identified;
using support::leaves_open;
using support::long_form;
using support::Score;

// Central values of the drawn friction of a joint. 6.3 mN m is 50 mN at the tip, as much as that of
// the tip itself; the viscous friction is ten times that of the tip there [chosen].
constexpr double kRubs = 6.3e-3, kRubsViscous = 1e-3;

/// Returns a vintage PHANTOM behind cables that stretch, whose motors have 1/3 to 3 times this
/// friction.
HiddenArm rubbing_arm(std::uint64_t seed) {
  HiddenArm arm = cabled_arm(seed);
  support::Random random(seed + 2000);
  auto& train = arm.file.simulated.drive_train;
  for (int i = 0; i < 3; ++i) train.coulomb[i] = kRubs * std::pow(3, random.uniform(-1, 1));
  for (int i = 0; i < 3; ++i) train.viscous[i] = kRubsViscous * std::pow(3, random.uniform(-1, 1));
  return arm;
}

TEST(IdentifyJointFriction, IsFoundForEachJointInAdditionToTheTip) {
  const int arms = long_form() ? 40 : 1;
  Score dry{"dry", 0.05}, viscous{"viscous", 0.25}, tip{"tip", 0.05}, gain{"gains", 0.02};
  Score mass{"mass", 0.03}, motor{"motor", 0.06}, stiffness{"cable", 0.06};
  Score resonance{"resonance", 0.05};
  int refused = 0;
  for (int k = 0; k < arms; ++k) {
    const auto seed = static_cast<std::uint64_t>(6102 + k);
    const HiddenArm arm = rubbing_arm(seed);
    const bool weighed = long_form() && k % 2 == 0;
    const auto found = identified(arm, {.seconds = long_form() ? 30.0 : 10.0,
                                        .known_mass = weighed ? support::kKnownMass : 0,
                                        .seed = seed});
    if (!found || !found->against.empty() || !found->play.friction.seen) {
      ++refused;
      std::printf("arm %d: %s\n", k,
                  !found                    ? found.error().message.c_str()
                  : !found->against.empty() ? found->against.front().c_str()
                                            : "no friction detected");
      continue;
    }
    EXPECT_FALSE(found->play.seen) << "arm " << k;
    const auto& train = arm.file.simulated.drive_train;
    const ArmConstants& constants = found->constants;
    // Motion without a known mass does not show the scale, so the mean gain is assumed to be 1.
    const double mean = weighed ? 1 : std::cbrt(arm.gain[0] * arm.gain[1] * arm.gain[2]);
    if (weighed) mass.add(constants.mass, arm.file.simulated.plant.mass);
    tip.add(constants.coulomb, arm.file.simulated.plant.coulomb / mean);
    for (std::size_t i = 0; i < 3; ++i) {
      const auto joint = static_cast<Eigen::Index>(i);
      const CableConstants& cable = (*constants.cables)[i];
      gain.add(constants.gain[i], arm.gain[i] / mean);
      const double rotor = train.inertia[joint] / mean, pulls = train.stiffness[joint] / mean;
      const double link = arm.file.simulated.plant.mass / mean * found->lines.JTJ(joint, joint);
      motor.add_outside_interval(cable.inertia, rotor);
      stiffness.add_outside_interval(cable.stiffness, pulls);
      resonance.add(cable.resonance,
                    std::sqrt(pulls * (1 / link + 1 / rotor)) / (2 * std::numbers::pi));
      dry.add(cable.coulomb, train.coulomb[joint] / mean);
      if (cable.viscous.value > 0) {
        viscous.add_outside_interval(cable.viscous, train.viscous[joint] / mean);
      }
    }
  }
  // One in fifty intervals of 95 % may miss by more than that: an arm whose search ended in a wrong
  // minimum, which cannot be detected (one of 39 does).
  constexpr double kMissed = 0.02;
  for (const Score* score : {&mass, &tip, &dry, &viscous, &gain, &motor, &stiffness, &resonance}) {
    score->print();
    EXPECT_LE(score->missed, kMissed * score->all) << score->name;
    EXPECT_GE(score->held, 0.9 * score->all - (long_form() ? 0 : 1)) << score->name;
  }
  std::printf("%d of %d arms refused\n", refused, arms);
  EXPECT_LE(refused, arms / 10);
}

TEST(IdentifyJointFriction, IsNotReportedForFreeMotors) {
  const int arms = long_form() ? 40 : 0;
  int reported = 0;
  double most = 0;
  for (int k = 0; k < arms; ++k) {
    const auto seed = static_cast<std::uint64_t>(105 + k);
    const auto found = identified(cabled_arm(seed), {.seconds = 30, .seed = seed});
    if (!found) {
      std::printf("arm %d: %s\n", k, found.error().message.c_str());
      continue;
    }
    EXPECT_FALSE(found->play.friction.seen) << "arm " << k;
    if (!found->play.friction.fits) continue;
    ++reported;
    EXPECT_TRUE(leaves_open(
        *found, "Dry friction of joints in addition to that of the tip: none detected above"))
        << "arm " << k;
    for (const Estimate& one : found->play.friction.coulomb) {
      most = std::max(most, one.value + one.plus_minus);
    }
  }
  std::printf("none of more than %.3g mN m in any of %d of %d arms\n", 1e3 * most, reported, arms);
  EXPECT_GE(reported, 0.75 * arms);
  EXPECT_LT(most, 0.15 * kRubs);
}

TEST(IdentifyJointFriction, IsWrittenWithItsInterval) {
  ArmConstants found = support::constants_behind_cables();
  const std::string text = support::text_of_arm("vintage_phantom");
  const IdentifiedMark mark{.date = "2026-11-26", .arm = "sim"};
  (*found.cables)[2].coulomb = {6.25e-3, 2e-4};
  const auto some = identified_text(text, found, mark);
  ASSERT_TRUE(some.ok()) << some.error().message;
  EXPECT_NE(
      some->find("    coulomb: [0, 0, 0.00625]  # N m at the joints [I 2026-11-26, sim, +- 0, "
                 "0, 0.0002]"),
      std::string::npos);
  // Only the viscous friction of the tip is written there.
  EXPECT_EQ(some->find("viscous: ["), std::string::npos);
  // A second measurement without friction must remove the old value.
  (*found.cables)[2].coulomb = {};
  const auto again = identified_text(*some, found, mark);
  ASSERT_TRUE(again.ok()) << again.error().message;
  EXPECT_NE(again->find("coulomb: [0, 0, 0]"), std::string::npos);
}

TEST(IdentifyJointFriction, NamesTheJointWithHighFriction) {
  Identified found;
  found.play.searched = found.play.fits = true;
  found.play.friction.fits = found.play.friction.seen = true;
  found.play.friction.shows_coulomb = {true, true, true};
  found.lines.JTJ = 0.0156 * Eigen::Matrix3d::Identity();  // a lever of 0.125 m
  found.constants.coulomb = {0.04, 0.001};
  found.constants.cables.emplace();
  auto& cables = *found.constants.cables;
  for (CableConstants& cable : cables) cable.coulomb = {0.002, 1e-4};
  EXPECT_EQ(fit_text(found).find("has far more friction"), std::string::npos);
  cables[1].coulomb.value = 0.02;
  EXPECT_NE(fit_text(found).find("Joint 2 has far more friction"), std::string::npos)
      << fit_text(found);
  EXPECT_TRUE(leaves_open(found, "Dry friction of a joint by direction: not identified."));
  // Friction as small as that of the tip is not reported.
  found.constants.coulomb.value = 0.2;
  EXPECT_EQ(fit_text(found).find("has far more friction"), std::string::npos);
}

}  // namespace
}  // namespace thimble::bringup
