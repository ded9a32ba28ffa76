// Backlash in the cables of hidden arms is found with its interval, and not reported where there is
// none.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <numbers>
#include <string>

#include "bringup/identify/output/identified_file.h"
#include "bringup/identify/unidentified_parameters.h"
#include "support/identify/identified_arm.h"
#include "support/identify/recorded_motion.h"
#include "support/long_form.h"
#include "support/random.h"

namespace thimble::bringup {
namespace {

using support::HiddenArm;
using support::identified;
using support::leaves_open;
using support::long_form;
using support::Score;

/// Returns a vintage PHANTOM behind cables that stretch, like those of identify_cables_test, with
/// backlash of 1/3 to 3 times `play` in each joint.
HiddenArm arm_with_backlash(std::uint64_t seed, double play) {
  HiddenArm arm = support::hidden_arm(seed);
  support::Random random(seed + 1000);
  auto& train = arm.file.simulated.drive_train;
  for (int i = 0; i < 3; ++i) {
    train.stiffness[i] = 20 * std::pow(10, random.uniform(0, 1));
    train.inertia[i] = 1e-4 * std::pow(9, random.uniform(0, 1));
    train.damping[i] = train.stiffness[i] * random.uniform(1e-4, 1e-3);
  }
  for (int i = 0; i < 3; ++i) train.play[i] = play * std::pow(3, random.uniform(-1, 1));
  return arm;
}

// Central value of the drawn widths, rad at the joint: 3 minutes of arc, as in a worn gear of a
// small drive. It is 0.14 mm at the tip, or 5 encoder steps [chosen].
constexpr double kBacklash = 1e-3;

TEST(IdentifyBacklash, FindsTheWidthAndTheCableBehindIt) {
  const int arms = long_form() ? 40 : 1;
  Score width{"play", 0.1}, resonance{"resonance", 0.05}, inertia{"motor", 0.06};
  Score gain{"gains", 0.02}, mass{"mass", 0.03};
  int refused = 0;
  for (int k = 0; k < arms; ++k) {
    const auto seed = static_cast<std::uint64_t>(6006 + k);
    HiddenArm arm = arm_with_backlash(seed, kBacklash);
    // Arms without backlash in any joint are tested in the long form.
    if (!long_form()) arm.file.simulated.drive_train.play[0] = 0;
    const bool weighed = long_form() && k % 2 == 0;
    const auto found = identified(arm, {.seconds = long_form() ? 30.0 : 10.0,
                                        .known_mass = weighed ? support::kKnownMass : 0,
                                        .seed = seed});
    if (!found || !found->against.empty() || !found->play.seen) {
      ++refused;
      std::printf("arm %d: %s\n", k,
                  !found                    ? found.error().message.c_str()
                  : !found->against.empty() ? found->against.front().c_str()
                                            : "no backlash detected");
      continue;
    }
    const auto& train = arm.file.simulated.drive_train;
    const ArmConstants& constants = found->constants;
    // Motion without a known mass does not show the scale, so the mean gain is assumed to be 1.
    const double mean = weighed ? 1 : std::cbrt(arm.gain[0] * arm.gain[1] * arm.gain[2]);
    const double moved = arm.file.simulated.plant.mass / mean;
    EXPECT_EQ(constants.absolute, weighed);
    EXPECT_FALSE(found->play.friction.seen) << "arm " << k;
    EXPECT_EQ(leaves_open(*found, "(joint 1), whole width."), !long_form());
    if (weighed) mass.add(constants.mass, moved);
    for (std::size_t i = 0; i < 3; ++i) {
      const auto joint = static_cast<Eigen::Index>(i);
      const CableConstants& cable = (*constants.cables)[i];
      const double link = moved * found->lines.JTJ(joint, joint);
      const double motor = train.inertia[joint] / mean, stiffness = train.stiffness[joint] / mean;
      EXPECT_EQ(found->play.shows[i], train.play[joint] > 0) << "joint " << i + 1;
      if (train.play[joint] > 0) width.add(cable.play, train.play[joint]);
      gain.add(constants.gain[i], arm.gain[i] / mean);
      inertia.add(cable.inertia, motor);
      resonance.add(cable.resonance,
                    std::sqrt(stiffness * (1 / link + 1 / motor)) / (2 * std::numbers::pi));
    }
  }
  for (const Score* score : {&mass, &width, &resonance, &inertia, &gain}) {
    score->print();
    EXPECT_LT(score->worst, score->max) << score->name;
    EXPECT_GE(score->held, 0.9 * score->all) << score->name;
  }
  std::printf("%d of %d arms refused\n", refused, arms);
  EXPECT_LE(refused, arms / 10);
}

TEST(IdentifyBacklash, ReportsItsDetectionLimit) {
  const int arms = long_form() ? 40 : 0;
  int reported = 0;
  double most = 0;
  for (int k = 0; k < arms; ++k) {
    const auto seed = static_cast<std::uint64_t>(105 + k);
    const auto found = identified(arm_with_backlash(seed, 0), {.seconds = 30, .seed = seed});
    if (!found) {
      std::printf("arm %d: %s\n", k, found.error().message.c_str());
      continue;
    }
    EXPECT_FALSE(found->play.seen) << "arm " << k;
    if (!found->play.fits) continue;
    ++reported;
    EXPECT_TRUE(leaves_open(*found, "Backlash: none detected above")) << "arm " << k;
    for (const Estimate& width : found->play.width) {
      most = std::max(most, width.value + width.plus_minus);
    }
  }
  std::printf("none of more than %.3g mrad in any of %d of %d arms\n", 1e3 * most, reported, arms);
  EXPECT_GE(reported, 0.75 * arms);
  EXPECT_LT(most, 0.1 * kBacklash);
}

TEST(IdentifyBacklash, OscillatingMotorIsNotTakenForLateReports) {
  // Its motor oscillates at 85 Hz under the force that holds the tip.
  const auto found = identified(arm_with_backlash(6007, kBacklash), {.seconds = 18, .seed = 6007});
  ASSERT_FALSE(found.ok());
  EXPECT_EQ(found.error().message.find("The motion cannot be used: in"), 0U)
      << found.error().message;
}

TEST(IdentifyBacklash, IsWrittenWithItsInterval) {
  ArmConstants found = support::constants_behind_cables();
  const std::string text = support::text_of_arm("vintage_phantom");
  const IdentifiedMark mark{.date = "2026-11-26", .arm = "sim"};
  const auto none = identified_text(text, found, mark);
  ASSERT_TRUE(none.ok()) << none.error().message;
  EXPECT_EQ(none->find("play:"), std::string::npos);
  (*found.cables)[1].play = {1.25e-3, 2e-5};
  const auto some = identified_text(text, found, mark);
  ASSERT_TRUE(some.ok()) << some.error().message;
  EXPECT_NE(
      some->find("play: [0, 0.00125, 0]  # rad, whole width at the joints [I 2026-11-26, sim, "
                 "+- 0, 2e-05, 0]"),
      std::string::npos);
  // A second measurement without backlash must remove the old width.
  (*found.cables)[1].play = {};
  const auto again = identified_text(*some, found, mark);
  ASSERT_TRUE(again.ok()) << again.error().message;
  EXPECT_NE(again->find("play: [0, 0, 0]"), std::string::npos);
}

}  // namespace
}  // namespace thimble::bringup
