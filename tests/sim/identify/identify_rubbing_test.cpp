// Friction of the joints of a rigid arm. It is found for each joint in addition to that of the tip,
// with intervals, not reported where there is none, and written to the file of the twin.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>

#include "bringup/identify/constants_table.h"
#include "bringup/identify/output/identified_file.h"
#include "bringup/identify/output/identified_further.h"
#include "support/identify/identified_arm.h"
#include "support/identify/recorded_motion.h"
#include "support/identify/rigid_rubbing_arm.h"
#include "support/long_form.h"

namespace thimble::bringup {
namespace {

using support::HiddenArm;
using support::identified;
using support::kJointDry;
using support::leaves_open;
using support::long_form;
using support::rigid_rubbing_arm;
using support::Score;

TEST(IdentifyRubbing, IsFoundForEachJointInAdditionToTheTip) {
  const int arms = long_form() ? 40 : 2;
  Score dry{"dry", 0.05}, viscous{"viscous", 0.10}, gain{"gains", 0.02}, mass{"mass", 0.03};
  Score delay{"delay", 1e-4};
  // Scores of arms whose tip has friction as well, whose sign reverses at about the same time.
  Score dry_beside{"dry*", 0.25}, viscous_beside{"viscous*", 0.3}, tip{"tip*", 3e-3};
  int refused = 0;
  for (int k = 0; k < arms; ++k) {
    const auto seed = static_cast<std::uint64_t>(8000 + k);
    const HiddenArm arm = rigid_rubbing_arm(seed);
    const auto found = identified(
        arm,
        {.seconds = long_form() ? 30.0 : 15.0, .known_mass = support::kKnownMass, .seed = seed});
    if (!found || !found->against.empty() || !found->rubbing.seen) {
      ++refused;
      std::printf("arm %d: %s\n", k,
                  !found                    ? found.error().message.c_str()
                  : !found->against.empty() ? found->against.front().c_str()
                                            : "no friction detected");
      continue;
    }
    const auto& train = arm.file.simulated.drive_train;
    mass.add(found->constants.mass, arm.file.simulated.plant.mass);
    delay.add(found->constants.delay, arm.delay, false);
    const bool beside = arm.file.simulated.plant.coulomb > 0;
    EXPECT_EQ(found->rubbing.tip_rubs, beside) << "arm " << k;
    tip.add(found->constants.coulomb, arm.file.simulated.plant.coulomb, false);
    for (std::size_t i = 0; i < 3; ++i) {
      const auto joint = static_cast<Eigen::Index>(i);
      gain.add(found->constants.gain[i], arm.gain[i]);
      (beside ? dry_beside : dry).add(found->joint_coulomb(i), train.coulomb[joint]);
      (beside ? viscous_beside : viscous).add(found->joint_viscous(i), train.viscous[joint]);
    }
  }
  support::expect_scores({&mass, &dry, &viscous, &gain, &delay, &dry_beside, &viscous_beside, &tip},
                         19);
  std::printf("%d of %d arms refused\n", refused, arms);
  EXPECT_LE(refused, arms / 10);
}

TEST(IdentifyRubbing, IsNotReportedIfOnlyTheTipHasFriction) {
  const int arms = long_form() ? 40 : 1;
  for (int k = 0; k < arms; ++k) {
    const auto seed = static_cast<std::uint64_t>(8100 + k);
    const auto found = identified(support::hidden_arm(seed), {.seconds = 30, .seed = seed});
    ASSERT_TRUE(found.ok()) << found.error().message;
    EXPECT_TRUE(found->rubbing.searched);
    EXPECT_FALSE(found->rubbing.seen) << "arm " << k;
    EXPECT_TRUE(leaves_open(
        *found, "Dry friction of joints in addition to that of the tip: none detected above"));
    for (const double below : found->rubbing.coulomb_below) EXPECT_LT(below, 2 * kJointDry);
  }
}

/// Returns an identified arm with friction of the joints.
Identified with_rubbing() {
  Identified found;
  found.constants.mass = {0.08, 0.001};
  for (Estimate& gain : found.constants.gain) gain = {2, 0.01};
  found.constants.delay = {0.0002, 1e-5};
  found.rubbing.searched = found.rubbing.seen = true;
  found.rubbing.coulomb = {Estimate{0.001, 1e-5}, {0.002, 2e-5}, {-1e-6, 2e-5}};
  found.rubbing.viscous = {Estimate{1e-4, 1e-5}, {2e-4, 2e-5}, {3e-4, 3e-5}};
  return found;
}

std::string text_with(const std::string& text, const Identified& found) {
  const IdentifiedMark mark{.date = "2026-11-26", .arm = "A 1"};
  const auto first = identified_text(text, found.constants, mark);
  EXPECT_TRUE(first.ok()) << first.error().message;
  const auto whole = further_text(*first, found, mark);
  EXPECT_TRUE(whole.ok()) << whole.error().message;
  return whole.ok() ? *whole : "";
}

TEST(IdentifyRubbing, IsWrittenJointByJointWithItsInterval) {
  Identified found = with_rubbing();
  const std::string some = text_with(support::text_of_arm("vintage_phantom"), found);
  EXPECT_NE(
      some.find("    coulomb: [0.002, 0.004, 0]  # N m at the joints [I 2026-11-26, A 1, +- "),
      std::string::npos)
      << some;
  EXPECT_NE(some.find("    viscous: [0.0002, 0.0004, 0.0006]  # N m s/rad at the joints [I "),
            std::string::npos);
  // A second measurement without friction must remove the old value.
  found.rubbing = {};
  found.rubbing.searched = true;
  const std::string none = text_with(some, found);
  EXPECT_NE(none.find("    coulomb: [0, 0, 0]  # N m at the joints [I "), std::string::npos);
  // Cogging is in the same section.
  Identified both = with_rubbing();
  both.waves.searched = true;
  both.waves.periods = 7;
  both.waves.cogging[0] = {.seen = true, .amplitude = {1e-3, 1e-5}, .phase = {0.5, 0.01}};
  const std::string section = text_with(support::text_of_arm("vintage_phantom"), both);
  EXPECT_EQ(section.find("drive_train:"), section.rfind("drive_train:"));
  EXPECT_NE(section.find("periods_per_turn: 7"), std::string::npos);
}

TEST(IdentifyRubbing, IsReportedForDirectionsThatDiffer) {
  Identified found = with_rubbing();
  MotionSample sample;
  sample.G = 8 * Eigen::Matrix3d::Identity();  // levers of 0.125 m
  found.moved.samples.push_back(sample);
  const auto value_of = [&](const std::string& name) {
    for (const ConstantRow& row :
         constant_rows(found, scene::load_arm("vintage_phantom").value())) {
      if (row.name == name) return row.found.value;
    }
    return std::nan("");
  };
  EXPECT_NEAR(value_of("Coulomb friction, joint 2"), 4, 1e-9);
  EXPECT_TRUE(std::isnan(value_of("  turning forwards, joint 2")));
  found.friction.directions_differ = true;
  found.friction.uneven[1] = {0.008, 0.001};  // N, 1 mN m
  EXPECT_NEAR(value_of("  turning forwards, joint 2"), 3, 1e-9);
  EXPECT_NEAR(value_of("  turning backwards, joint 2"), 5, 1e-9);
}

TEST(IdentifyRubbing, NamesTheJointThatSticks) {
  JointFrictionFit rubbing = with_rubbing().rubbing;
  const Eigen::Vector3d levers(0.14, 0.14, 0.14);
  rubbing.coulomb = {Estimate{0.001, 1e-5}, {0.02, 2e-4}, {0.0015, 1e-5}};
  EXPECT_EQ(rubbing.stuck(0.04, levers), 1);
  EXPECT_EQ(rubbing.stuck(0.2, levers), -1) << "the tip has more friction";
  rubbing.coulomb[2].value = 0.003;
  EXPECT_EQ(rubbing.stuck(0.04, levers), -1) << "another joint has high friction too";
}

}  // namespace
}  // namespace thimble::bringup
