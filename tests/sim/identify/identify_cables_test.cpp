#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <numbers>
#include <set>

#include "bringup/identify/line_forces.h"
#include "bringup/identify/unidentified_parameters.h"
#include "support/identify/cabled_arm.h"
#include "support/identify/identified_arm.h"
#include "support/long_form.h"
#include "support/random.h"

namespace thimble::bringup {
namespace {

using support::cabled_arm;
using support::expect_scores;
using support::hidden_arm;
using support::HiddenArm;
using support::identified;
using support::kKnownMass;
using support::long_form;
using support::Score;

TEST(IdentifyCables, FindsCablesAndTheLinksBehindThem) {
  const int arms = long_form() ? 20 : 1;
  Score mass{"mass", 0.03}, gain{"gain", 0.02}, delay{"delay", 1e-4}, coulomb{"Coulomb", 0.05};
  Score resonance{"resonance", 0.05}, antiresonance{"antires.", 0.08}, inertia{"motor", 0.06};
  int refused = 0;
  for (int k = 0; k < arms; ++k) {
    const auto seed = static_cast<std::uint64_t>(6000 + k);
    const HiddenArm arm = cabled_arm(seed);
    const auto found = identified(arm, {.seconds = long_form() ? 30.0 : 20.0,
                                        .play = long_form(),
                                        .known_mass = kKnownMass,
                                        .seed = seed});
    if (!found) {
      // Its motor oscillates under the force that holds the tip, so the motion cannot be measured.
      EXPECT_EQ(found.error().message.find("The motion cannot be used: in"), 0U)
          << found.error().message;
      ++refused;
      continue;
    }
    ASSERT_TRUE(found->constants.cables) << "arm " << k;
    EXPECT_TRUE(found->against.empty()) << "arm " << k << ": " << found->against.front();
    EXPECT_EQ(found->play.fits_to_steps(), long_form()) << "arm " << k;
    EXPECT_FALSE(found->play.seen) << "arm " << k;
    const auto& plant = arm.file.simulated.plant;
    const auto& train = arm.file.simulated.drive_train;
    const ArmConstants& constants = found->constants;
    mass.add(constants.mass, plant.mass);
    coulomb.add(constants.coulomb, plant.coulomb);
    delay.add(constants.delay, arm.delay, false);
    for (std::size_t i = 0; i < 3; ++i) {
      const auto joint = static_cast<Eigen::Index>(i);
      const CableConstants& cable = (*constants.cables)[i];
      const double link = plant.mass * found->lines.JTJ(joint, joint);
      const double motor = train.inertia[joint], stiffness = train.stiffness[joint];
      const double turn = 2 * std::numbers::pi;
      gain.add(constants.gain[i], arm.gain[i]);
      inertia.add(cable.inertia, motor);
      antiresonance.add(cable.antiresonance, std::sqrt(stiffness / link) / turn);
      resonance.add(cable.resonance, std::sqrt(stiffness * (1 / link + 1 / motor)) / turn);
    }
  }
  EXPECT_LE(refused, arms / 10);
  constexpr int kFew = 10;
  expect_scores({&mass, &coulomb, &gain, &delay, &resonance, &antiresonance, &inertia}, kFew);
}

TEST(IdentifyCables, FindsOrReportsUnseenResonances) {
  const int arms = long_form() ? 20 : 1;
  int seen = 0;
  double worst = 0;
  for (int k = 0; k < arms; ++k) {
    const auto seed = static_cast<std::uint64_t>(105 + k);
    const HiddenArm arm = cabled_arm(seed, 200);
    const auto found =
        identified(arm, {.seconds = long_form() ? 30.0 : 20.0, .play = long_form(), .seed = seed});
    ASSERT_TRUE(found.ok()) << found.error().message;
    ASSERT_TRUE(found->constants.cables) << "arm " << k << ": no cables found";
    if (!found->against.empty()) continue;
    const auto sentences = unidentified_parameters(*found);
    for (std::size_t i = 0; i < 3; ++i) {
      const auto joint = static_cast<Eigen::Index>(i);
      const auto& train = arm.file.simulated.drive_train;
      const double link = arm.file.simulated.plant.mass * found->lines.JTJ(joint, joint);
      const double truth =
          std::sqrt(train.stiffness[joint] * (1 / link + 1 / train.inertia[joint])) /
          (2 * std::numbers::pi);
      const Estimate& resonance = (*found->constants.cables)[i].resonance;
      if (CableConstants::sees(resonance)) {
        worst = std::max(worst, std::abs(resonance.value / truth - 1));
        ++seen;
        continue;
      }
      const std::string name = "Resonance of motor and link " + std::to_string(i + 1);
      EXPECT_TRUE(std::any_of(sentences.begin(), sentences.end(),
                              [&](const std::string& one) { return one.find(name) == 0; }));
    }
  }
  std::printf("%d resonances seen, the worst %.3g off\n", seen, worst);
  EXPECT_GT(seen, 0);
  EXPECT_LT(worst, 0.05);
}

TEST(IdentifyCables, AreNotWrittenIfAHandHoldsTheTip) {
  // Backlash is searched for; its fit has a separate spring at the tip.
  const int arms = long_form() ? 12 : 1;
  support::Random random(77);
  for (int k = 0; k < arms; ++k) {
    const auto seed = static_cast<std::uint64_t>(6004 + k);
    HiddenArm arm = cabled_arm(seed, k % 2 == 0 ? 20 : 200);
    auto& hand = arm.file.simulated.hand;
    hand.stiffness = 30 * std::pow(30, random.uniform(0, 1));
    hand.damping = random.uniform(0.5, 5);
    hand.mass = random.uniform(0.005, 0.05);
    const auto found = identified(arm, {.seconds = long_form() ? 30.0 : 12.0, .seed = seed}, true);
    if (!found) {
      // A firm hand: joints do not follow their motors.
      EXPECT_NE(found.error().message.find("such as a hand"), std::string::npos)
          << found.error().message;
      continue;
    }
    ASSERT_FALSE(found->against.empty())
        << "arm " << k << ", a hand of " << hand.stiffness << " N/m";
    EXPECT_EQ(found->against.front().find("Something holds the tip like a spring of"), 0U)
        << found->against.front();
  }
}

TEST(IdentifyCables, ReportsItsDetectionLimit) {
  const auto found = identified(hidden_arm(7), {.seconds = long_form() ? 20.0 : 12.0});
  ASSERT_TRUE(found.ok()) << found.error().message;
  EXPECT_GT(found->lines.unseen_from.minCoeff(), 100);
  const auto sentences = unidentified_parameters(*found);
  EXPECT_TRUE(std::any_of(sentences.begin(), sentences.end(), [](const std::string& one) {
    return one.find("no compliance detected") != std::string::npos;
  }));
  EXPECT_TRUE(std::any_of(sentences.begin(), sentences.end(), [](const std::string& one) {
    return one.find("Backlash: not searched.") == 0;
  }));
}

TEST(LineForces, AreDistinctOddMultiplesAndSmall) {
  std::set<long> seen;
  for (int axis = 0; axis < 3; ++axis) {
    for (int line = 0; line < LineForces::kLines; ++line) {
      const double multiple = LineForces::frequency(axis, line) / LineForces::kBase;
      EXPECT_EQ(multiple, std::round(multiple));
      EXPECT_TRUE(seen.insert(std::lround(multiple)).second) << multiple;
      EXPECT_EQ(std::lround(multiple) % 2, 1);
    }
  }
  const LineForces forces(1);
  double square = 0;
  constexpr int kTicks = 4000;
  for (int i = 0; i < kTicks; ++i) square += forces.force(1e-3 * i).squaredNorm() / kTicks;
  EXPECT_LT(std::sqrt(square), 0.4);
}

}  // namespace
}  // namespace thimble::bringup
