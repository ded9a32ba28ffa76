// The random search for trouble, and what it measures by.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "figure.h"
#include "stability_laws.h"
#include "study/random_scene.h"
#include "study/trouble_run.h"
#include "study/wall_measures.h"
#include "support/scratch.h"
#include "text_file.h"

namespace thimble::app {
namespace {

const std::filesystem::path kArm =
    std::filesystem::path(THIMBLE_SOURCE_DIR) / "app/arms/vintage_phantom.yaml";

RandomSceneLimits limits() {
  return {.arm = *read_arm_file(kArm), .arm_path = kArm.string(), .mesh_path = "meshes"};
}

std::vector<std::filesystem::path> worst_scenes() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(THIMBLE_TEST_DATA) / "trouble")) {
    if (entry.path().extension() == ".yaml") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

TEST(Trouble, DoesNotComeBackInTheWorstScenesOfALongSearch) {
  const auto files = worst_scenes();
  ASSERT_EQ(files.size(), 10U);
  for (const auto& file : files) {
    // Nothing in these scenes has energy of its own: no weights, no fields.
    const TroubleFound found = run_for_trouble(file, {.text = "", .own_energy = 0});
    EXPECT_FALSE(found.refused) << file;
    EXPECT_EQ(found.not_finite, 0) << file;
    EXPECT_EQ(found.fault, 0) << file;
    EXPECT_LE(found.force_share, 1 + 1e-9) << file;
    EXPECT_LE(found.excess, kEnergyAllowed) << file;
    EXPECT_GT(found.contact, 0.2) << file;
  }
}

TEST(Trouble, IsSeenWhereAWallIsFarTooStiffForItsHand) {
  const auto file = support::scratch_folder() / "too_stiff.yaml";
  ASSERT_TRUE(
      write_text("name: too_stiff\narm: " + kArm.string() +
                     "\nduration: 2\ngate: {energy: none}\n"
                     "objects:\n  - {name: wall, plane: {normal: [0, 0, 1]}, stiffness: 9000}\n"
                     "hand:\n  grip: {mass: 0.01, stiffness: 100, damping: 0.2, tremor: 0}\n"
                     "  path:\n    - {t: 0, at: [0, 0, 0.02]}\n    - {t: 0.6, at: [0, 0, -0.01]}\n"
                     "    - {t: 2, at: [0, 0, -0.01]}\n",
                 file));
  const TroubleFound found = run_for_trouble(file, {});
  EXPECT_FALSE(found.refused);
  EXPECT_TRUE(found.bad());
  EXPECT_GT(found.excess, 10 * kEnergyAllowed);
  EXPECT_GT(found.given, 10 * kEnergyAllowed);
  EXPECT_GT(found.tremble, 0.1);
}

TEST(RandomScene, IsDrawnAgainByItsSeedAndByNoOther) {
  EXPECT_EQ(random_scene(7, limits()).text, random_scene(7, limits()).text);
  EXPECT_NE(random_scene(7, limits()).text, random_scene(8, limits()).text);
}

TEST(RandomScene, StaysWithinWhatTheLawsAllow) {
  RandomSceneLimits none = limits();
  none.arm.declared.stiffness = 60;  // what an arm declares binds too
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const std::string text = random_scene(seed, none).text;
    for (std::size_t at = text.find("\n    stiffness: "); at != std::string::npos;
         at = text.find("\n    stiffness: ", at + 1)) {
      EXPECT_LE(std::stod(text.substr(at + 16)), 60) << seed;
    }
  }
}

TEST(TroubleFound, SurvivesItsWayThroughASweep) {
  const TroubleFound found{.not_finite = 2,
                           .fault = 3,
                           .force_share = 0.5,
                           .excess = 0.01,
                           .tremble = 0.1,
                           .must_tremble = true,
                           .speed = 1,
                           .given = 0.02,
                           .contact = 0.4};
  EXPECT_EQ(numbers_of(trouble_of(numbers_of(found))), numbers_of(found));
  EXPECT_TRUE(found.bad());
}

TEST(WallMeasures, FindTheEdgeThatTheExactMapOfATickHas) {
  const auto arm = read_arm_file(kArm);
  for (const double delay : {0.0, 0.001}) {
    WallCase wall;
    wall.direction = *worst_direction_at_home(*arm);
    wall.tip = {.mass = 0.075, .viscous = 1, .coulomb = 0};
    wall.delay_ns = static_cast<std::int64_t>(delay * 1e9);
    wall.duration = 4;
    const double exact = stiffness_edge({.mass = 0.075, .viscous = 1, .delay = delay});
    EXPECT_NEAR(linear_edge(*arm, wall, exact / 2, exact * 2) / exact, 1, 0.01) << delay;
  }
}

TEST(WallMeasures, FindRestOnlyWhereDryFrictionHoldsHalfAStep) {
  const auto arm = read_arm_file(kArm);
  WallCase wall;
  wall.direction = *worst_direction_at_home(*arm);
  wall.stiffness = 1000;
  wall.step = 2e-4;
  wall.tip = {.mass = 0.075, .viscous = 1, .coulomb = 0};
  for (const double sigma : {0.4, 0.48}) {
    wall.tip.coulomb = sigma * wall.stiffness * wall.step;
    EXPECT_GT(released_swing(*arm, wall, 0.08, 3), 0) << sigma;
  }
  for (const double sigma : {0.52, 0.6}) {
    wall.tip.coulomb = sigma * wall.stiffness * wall.step;
    EXPECT_EQ(released_swing(*arm, wall, 0.08, 3), 0) << sigma;
  }
}

TEST(WallMeasures, ThrowBackAsTheLawOfRestitutionSays) {
  const auto arm = read_arm_file(kArm);
  WallCase wall;
  wall.direction = *worst_direction_at_home(*arm);
  wall.tip = {.mass = 0.075, .viscous = 0.005, .coulomb = 0};
  wall.stiffness = 1000;
  const Restitution found = throw_at_wall(*arm, wall, 50);
  EXPECT_NEAR(found.mean, restitution(1000, 0.005, 0.075, 0.0005), 0.01);
  EXPECT_LE(found.least, found.mean);
  EXPECT_GE(found.most, found.mean);
}

TEST(WallMeasures, MakeLateAndSpreadTicksOfTheMeanThatTheLawIsAsked) {
  const auto sum_of = [](const std::vector<std::int64_t>& gaps) {
    double sum = 0, squares = 0;
    for (const std::int64_t gap : gaps) {
      sum += static_cast<double>(gap) * 1e-9;
      squares += static_cast<double>(gap) * static_cast<double>(gap) * 1e-18;
    }
    return squares / (2 * sum);
  };
  const double late = sum_of(late_ticks(1'000'000, 0.1, 3, 1));
  EXPECT_NEAR(late, (0.9 + 0.1 * 16) / (2 * 1.3) * 1e-3, 1e-9);
  const double spread = sum_of(spread_ticks(1'000'000, 0.9, 50'000, 1));
  EXPECT_NEAR(spread, 0.5e-3 * (1 + 0.81 / 3), 2e-6);
}

}  // namespace
}  // namespace thimble::app
