// The hand's constants are guesses [PHYSICS 9], so the shipped walls must be stable for a third and
// three times each constant.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "energy_guard_settings.h"
#include "stability/tuning.h"
#include "stability/wall_trial.h"
#include "support/hard_case.h"
#include "support/wall_rig.h"
#include "thimble/scene/scene_file.h"

namespace thimble {
namespace {

/// Returns the distinct walls (N/m, N s/m) of all shipped scenes, each with its arm and rate.
std::vector<std::pair<scene::Scene, scene::SceneObject>> shipped_walls() {
  std::vector<std::pair<scene::Scene, scene::SceneObject>> walls;
  std::set<std::array<double, 3>> seen;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::string(THIMBLE_SOURCE_DIR) + "/app/scenes")) {
    if (entry.path().extension() != ".yaml") continue;
    auto scene = scene::load_scene(entry.path(), {.mesh_folder = THIMBLE_MESHES});
    if (!scene) continue;  // a mesh is not installed; the walls of other scenes are the same
    for (const scene::SceneObject& object : scene->objects) {
      if (object.build_field || !(object.stiffness > 0)) continue;
      if (!seen.insert({object.stiffness, object.damping, scene->rate}).second) continue;
      walls.emplace_back(*scene, object);
    }
  }
  return walls;
}

/// Returns all hands with 1/3, 1 and 3 times the mass, stiffness and damping.
std::vector<device_sim::HandSettings> hands_around(device_sim::HandSettings hand) {
  std::vector<device_sim::HandSettings> hands;
  hand.tremor_amplitude = 0;
  const std::array<double, 3> times{1.0 / 3, 1, 3};
  for (const double mass : times) {
    for (const double stiffness : times) {
      for (const double damping : times) {
        hands.push_back(hand);
        hands.back().mass *= mass;
        hands.back().stiffness *= stiffness;
        hands.back().damping *= damping;
      }
    }
  }
  return hands;
}

std::string reported(const device_sim::HandSettings& hand) {
  char buffer[100];
  std::snprintf(buffer, sizeof buffer, "hand of %.3g kg, %.3g N/m, %.3g N s/m", hand.mass,
                hand.stiffness, hand.damping);
  return buffer;
}

double thrown_back(const support::Wall& wall, double speed, double phase) {
  support::WallRig rig(wall);
  rig.state = {.x = 0, .v = -speed};
  rig.drift(static_cast<std::int64_t>(phase * static_cast<double>(wall.period_ns)));
  const auto late = static_cast<int>(wall.delay_ns / wall.period_ns) + 2;
  for (int k = 0, outside = 0; k < 5000 && outside < late; ++k) {
    rig.tick();
    outside = rig.state.x > 0 ? outside + 1 : 0;
    if (rig.state.v == 0 && k > 1000) break;
  }
  return std::max(0.0, rig.state.v) / speed;
}

TEST(HandConstants, NoHandIsThrownBackFasterByAnyShippedWall) {
  double most = 0;
  int walls = 0;
  for (const auto& [scene, object] : shipped_walls()) {
    for (const device_sim::HandSettings& hand :
         hands_around(scene.arms.front().arm.simulated.hand)) {
      support::Wall wall{.plant = scene.arms.front().arm.simulated.plant, .hand = hand};
      wall.stiffness = object.stiffness;
      wall.damping = object.damping;
      wall.encoder_step = 3e-5;
      wall.velocity_corner = scene.arms.front().arm.velocity_corner_frequency;
      wall.period_ns = std::llround(1e9 / scene.rate);
      wall.delay_ns = std::llround(1e9 * scene::loop_delay(scene.arms.front().arm));
      for (const double speed : {0.05, 0.2, 1.0}) {
        for (int i = 0; i < 20; ++i) {
          const double e = thrown_back(wall, speed, (i + 0.5) / 20);
          EXPECT_LE(e, 1) << object.name << " " << object.stiffness << ", " << reported(hand);
          most = std::max(most, e);
        }
      }
    }
    ++walls;
  }
  EXPECT_GE(walls, 8);
  support::record_hard_case(7, "every shipped wall, 27 hands of x1/3 to x3, 0.05 to 1 m/s",
                            "<= largest restitution", most, 1, "1");
}

/// Oscillation of a wall with all hands, pressed along each axis through the complete chain,
/// without the gate's energy stage, which would help.
struct Unrest {
  int loud = 0;  ///< Number of hands and axes with more than 20 mN RMS of force.
  int tried = 0;
  double force_rms = 0;  ///< Max. RMS force, N.
  std::string who;
};

Unrest unrest_of(const scene::ArmFile& file, double rate, double stiffness, double damping) {
  Unrest found;
  for (const device_sim::HandSettings& hand : hands_around(file.simulated.hand)) {
    scene::ArmFile arm = file;
    arm.simulated.hand = hand;
    for (int axis = 0; axis < 3; ++axis) {
      const auto touch = stability::press_on_wall(arm, {.p_W = {0, 0, 0},
                                                        .n_W = Eigen::Vector3d::Unit(axis),
                                                        .stiffness = stiffness,
                                                        .damping = damping,
                                                        .rate = rate,
                                                        .press = 1});
      if (!touch) continue;
      EXPECT_FALSE(touch->fault);
      ++found.tried;
      // Perception threshold [PHYSICS 6].
      if (touch->force_rms > 0.02) ++found.loud;
      if (touch->force_rms < found.force_rms) continue;
      found.force_rms = touch->force_rms;
      found.who = reported(hand);
    }
  }
  EXPECT_GE(found.tried, 54);
  return found;
}

TEST(HandConstants, EveryHandRestsOnEveryShippedWall) {
  double most = 0;
  for (const auto& [scene, object] : shipped_walls()) {
    const Unrest unrest =
        unrest_of(scene.arms.front().arm, scene.rate, object.stiffness, object.damping);
    EXPECT_EQ(unrest.loud, 0) << object.name << " " << object.stiffness << ", " << unrest.who;
    most = std::max(most, unrest.force_rms);
    const stability::StabilityLimits carried = stability::stability_limits(
        scene.arms.front().arm, stability::loop_times(scene.arms.front().arm, scene.rate),
        object.stiffness, object.damping);
    EXPECT_LE(object.stiffness, carried.stiffness_safe) << object.name;
  }
  support::record_hard_case(7, "the same walls pressed along three axes, through wire and gate",
                            "<= RMS of the force at rest", 1e3 * most, 20, "mN");
}

TEST(HandConstants, EveryHandRestsOnTunedWalls) {
  double most = 0;
  for (const char* const name : {"vintage_phantom", "woodenhaptics", "polhem"}) {
    const auto arm =
        scene::load_arm(std::string(THIMBLE_SOURCE_DIR) + "/app/arms/" + name + ".yaml");
    ASSERT_TRUE(arm);
    for (const double damping : {0.0, 1.0}) {
      const stability::StabilityLimits carried =
          stability::stability_limits(*arm, stability::loop_times(*arm, 1000), 800, damping);
      EXPECT_LT(carried.stiffness_any_hand, 0.7 * carried.stiffness_exact);
      EXPECT_LT(carried.stiffness_safe, carried.stiffness_any_hand);
      EXPECT_DOUBLE_EQ(carried.worst_hand.damping, arm->simulated.hand.damping / 3);
      const Unrest unrest = unrest_of(*arm, 1000, carried.stiffness_safe, damping);
      EXPECT_EQ(unrest.loud, 0) << name << " " << damping << ", " << unrest.who;
      most = std::max(most, unrest.force_rms);
    }
  }
  support::record_hard_case(7, "walls as stiff as tune calls safe, three arms, 27 hands",
                            "<= RMS of the force at rest", 1e3 * most, 20, "mN");
}

TEST(HandConstants, GuardLowImpedanceGripOscillates) {
  const auto arm =
      scene::load_arm(std::string(THIMBLE_SOURCE_DIR) + "/app/arms/vintage_phantom.yaml");
  ASSERT_TRUE(arm);
  const stability::StabilityLimits carried =
      stability::stability_limits(*arm, stability::loop_times(*arm, 1000), 800, 0);
  // 0.7 of the edge with the hand of the file; a third of its damping is not enough.
  const Unrest unrest = unrest_of(*arm, 1000, 0.7 * carried.stiffness_exact, 0);
  EXPECT_EQ(unrest.loud, 27);  // all with 1 N s/m, and none with 3 or 9
  support::record_hard_case(7, "guard: 0.7 of the edge with the hand of the file, 27 hands",
                            "> RMS of the force at rest", 1e3 * unrest.force_rms, 20, "mN");
}

}  // namespace
}  // namespace thimble
