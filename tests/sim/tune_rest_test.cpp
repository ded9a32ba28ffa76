// Warnings of `thimble tune` about oscillations at rest, compared with the behaviour of scenes, as
// `thimble study trouble` does for its random scenes.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "stability/rest_trial.h"
#include "stability/rest_warnings.h"
#include "stability/signal.h"
#include "stability/tuning.h"
#include "studies/fuzz_scenes/random_scene.h"
#include "studies/fuzz_scenes/small_meshes.h"
#include "studies/fuzz_scenes/trouble_run.h"
#include "support/contact_walk.h"
#include "support/long_form.h"
#include "support/meshes/concave_solids.h"
#include "support/scratch.h"
#include "thimble/render/mesh/mesh_file.h"
#include "thimble/scene/arm_simulation.h"
#include "thimble/session/session.h"

namespace thimble::stability {
namespace {

const std::filesystem::path kArm =
    std::filesystem::path(THIMBLE_SOURCE_DIR) / "app/arms/vintage_phantom.yaml";

/// Runs a scene until `time` (s), holds the hand there for 1.6 s, and returns the force above 50 Hz
/// in the last quarter of a second, N RMS.
double oscillation_stopped_at(const std::filesystem::path& file, double time) {
  const auto session = session::Session::open(file, {.duration = time + 1.6});
  EXPECT_TRUE(session);
  if (!session) return 0;
  const double rate = (*session)->scene().rate;
  const auto stop = static_cast<std::size_t>(std::llround(time * rate));
  for (std::size_t tick = 0;; ++tick) {
    if (tick == stop) (*session)->simulation()->hold(true);
    if ((*session)->step()) break;
  }
  double square = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::vector<double> force;
    for (const auto& row : (*session)->ticks()) force.push_back(row.f_sent_W[axis]);
    const std::vector<double> fast = high_passed(force, rate, 50);
    const auto watched = static_cast<std::size_t>(0.25 * rate);
    for (std::size_t i = fast.size() - watched; i < fast.size(); ++i) square += fast[i] * fast[i];
  }
  return std::sqrt(square / (0.25 * rate));
}

/// Returns the warnings of `tune` for the hand of a scene, except those about the energy stage.
std::vector<std::string> warnings_of(const scene::Scene& scene) {
  std::vector<std::string> warnings;
  const auto trial = try_rests(scene, scene.arms.front().arm.simulated.hand);
  EXPECT_TRUE(trial) << trial.error().message;
  if (trial) warnings = rest_warnings(scene, *trial);
  const std::size_t by_law = stability_warnings(scene).size() - energy_warnings(scene).size();
  warnings.resize(warnings.size() + by_law, "a wall is too stiff");
  return warnings;
}

TEST(TuneRest, WarnsOfRandomScenesThatOscillateAndOfNoOthers) {
  const auto folder = support::scratch_folder();
  ASSERT_TRUE(studies::write_small_meshes(folder / "meshes"));
  const studies::RandomSceneLimits limits{
      .arm = *scene::load_arm(kArm), .arm_path = kArm.string(), .mesh_path = "meshes"};
  // Scenes of the long search in which the tip oscillates, followed by random ones.
  std::vector<std::uint64_t> seeds{0x9e0ae1da2e824ea6, 0x12d51};
  const int count = support::long_form() ? 300 : 40;
  for (int i = 0; i < count; ++i) seeds.push_back(77'000 + static_cast<std::uint64_t>(i));
  int ran = 0, oscillate = 0, alarms = 0, wrong = 0, missed = 0, by_rules = 0, rules_wrong = 0;
  for (const std::uint64_t seed : seeds) {
    const studies::RandomScene drawn = studies::random_scene(seed, limits);
    const auto file = folder / "scene.yaml";
    std::ofstream(file) << drawn.text;
    const studies::TroubleFound found = studies::run_for_trouble(file, drawn);
    if (found.refused || found.bad()) continue;
    const auto scene = scene::load_scene(file);
    ASSERT_TRUE(scene);
    ++ran;
    bool oscillates = found.limit_cycle > studies::kLimitCycleMax;
    const bool alarm = !warnings_of(*scene).empty();
    if (alarm && !oscillates) {
      // If the hand touches nothing at the end of its path, tune stops it earlier on the path.
      const auto trial = try_rests(*scene, scene->arms.front().arm.simulated.hand);
      ASSERT_TRUE(trial && trial->worst());
      oscillates = oscillation_stopped_at(file, trial->worst()->time) > studies::kLimitCycleMax;
    }
    const bool rule = !rest_causes(*scene).empty();
    oscillate += oscillates;
    alarms += alarm;
    wrong += alarm && !oscillates;
    missed += oscillates && !alarm;
    by_rules += rule;
    rules_wrong += rule && !oscillates;
    if (alarm || oscillates) {
      std::printf("  seed %llx: %.4f N RMS, %s\n", static_cast<unsigned long long>(seed),
                  found.limit_cycle, alarm ? "warned of" : "missed");
    }
  }
  std::printf(
      "  of %d scenes %d oscillate; %d warnings, %d of them wrong, %d missed (from the laws only: "
      "%d warnings, %d wrong)\n",
      ran, oscillate, alarms, wrong, missed, by_rules, rules_wrong);
  EXPECT_GT(ran, count * 3 / 4);
  EXPECT_GT(oscillate, 1);
  EXPECT_EQ(missed, 0);
  EXPECT_LT(wrong, 0.05 * alarms + 1e-9);
}

TEST(TuneRest, IsSilentOnShippedScenes) {
  int scenes = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(kArm.parent_path().parent_path() / "scenes")) {
    if (entry.path().extension() != ".yaml") continue;
    const auto scene = scene::load_scene(entry.path());
    if (!scene) {  // two hands, or a scan that is not installed
      std::printf("  not tried: %s\n", scene.error().message.c_str());
      continue;
    }
    ++scenes;
    const auto warnings = warnings_of(*scene);
    EXPECT_TRUE(warnings.empty()) << scene->name << ": " << warnings[0];
  }
  EXPECT_GE(scenes, 14);
}

// Two faces hold the tip at once, so no warning is due.
TEST(TuneRest, IsSilentInAGroove) {
  const auto folder = support::scratch_folder();
  const double slope = std::atan2(0.017, 0.03), wall = std::hypot(0.017, 0.03);
  const support::ConcaveSolid hollow = support::groove(slope, slope, wall, wall, {-0.03, 0.03});
  ASSERT_TRUE(render::save_mesh(hollow.mesh, folder / "hollow.off"));
  for (const std::string tracker : {"edge_planes", "offset", "compact", "god_object"}) {
    const auto file = folder / "groove.yaml";
    std::ofstream(file)
        << "name: groove\narm: " << kArm.string()
        << "\nduration: 1\ngate: {energy: none}\nobjects:\n  - name: groove\n"
        << "    mesh: hollow.off\n    scale: 1\n    position: [0, 0, -0.014]\n"
        << "    stiffness: 500\n    damping: 0\n    contact: {tracker: " << tracker
        << "}\nhand:\n  grip: {tremor: 0}\n  path:\n    - {t: 0, at: [0, 0, 0.03]}\n"
        << "    - {t: 0.5, at: [0.001, 0, -0.009]}\n"
        << "    - {t: 0.9, at: [0, 0, -0.009]}\n";
    const auto scene = scene::load_scene(file);
    ASSERT_TRUE(scene) << scene.error().message;
    const auto trial = try_rests(*scene, scene->arms.front().arm.simulated.hand);
    ASSERT_TRUE(trial) << trial.error().message;
    ASSERT_NE(trial->worst(), nullptr);
    EXPECT_EQ(trial->worst()->on, "groove");
    EXPECT_GT(trial->worst()->force, 0.5);
    const auto warnings = rest_warnings(*scene, *trial);
    std::printf("  %-18s %.4f N RMS\n", tracker.c_str(), trial->worst()->oscillation);
    EXPECT_TRUE(warnings.empty()) << warnings[0];
    EXPECT_LT(trial->worst()->oscillation, 0.001) << tracker;
  }
}

// If a path only strokes an object, the hand is stopped inside it.
TEST(TuneRest, StopsTheHandInAStrokedObject) {
  const auto folder = support::scratch_folder();
  const auto file = folder / "stroke.yaml";
  std::ofstream(file)
      << "name: stroke\narm: " << kArm.string()
      << "\nduration: 1.2\ngate: {energy: none}\nobjects:\n"
      << "  - {name: wall, plane: {normal: [0, 0, 1]}, stiffness: 400}\n"
      << "hand:\n  path:\n    - {t: 0, at: [0, 0, 0.02]}\n"
      << "    - {t: 0.6, at: [0.01, 0, -0.01]}\n    - {t: 1, at: [0.02, 0, 0.02]}\n";
  const auto scene = scene::load_scene(file);
  ASSERT_TRUE(scene) << scene.error().message;
  const auto trial = try_rests(*scene, scene->arms.front().arm.simulated.hand);
  ASSERT_TRUE(trial) << trial.error().message;
  ASSERT_EQ(trial->rests.size(), 2u);  // one in the air, one on the wall
  EXPECT_EQ(trial->rests[0].on, "");
  EXPECT_EQ(trial->rests[1].on, "wall");
  EXPECT_NEAR(trial->rests[1].time, 0.6, 0.1);
  EXPECT_GT(trial->rests[1].force, 0.3);
}

}  // namespace
}  // namespace thimble::stability
