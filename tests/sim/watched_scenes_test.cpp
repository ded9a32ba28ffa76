// No shipped scene is mistaken for a broken arm, with any hand; every shipped arm with reversed
// motors is detected.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include "support/scratch.h"
#include "thimble/scene/scene_file.h"
#include "thimble/session/session.h"

namespace thimble {
namespace {

struct Grip {
  const char* name;
  double mass, stiffness, damping, tremor;  // kg, N/m, N s/m, m
};

class WatchedScene : public ::testing::TestWithParam<const char*> {};

TEST_P(WatchedScene, NoHandLooksLikeABrokenArm) {
  for (const Grip& grip :
       {Grip{"low-impedance", 0.01, 100, 1, 5e-5}, Grip{"high-impedance", 0.05, 1000, 10, 5e-5},
        Grip{"stiff and without damping", 0.025, 1000, 1, 0}, Grip{"heavy", 0.1, 300, 3, 0}}) {
    session::SessionOptions options;
    options.adjust = [&](scene::Scene& scene) {
      device_sim::HandSettings& hand = scene.arms.front().arm.simulated.hand;
      hand.mass = grip.mass;
      hand.stiffness = grip.stiffness;
      hand.damping = grip.damping;
      hand.tremor_amplitude = grip.tremor;
    };
    const auto file = std::filesystem::path(THIMBLE_SOURCE_DIR) / "app/scenes" / GetParam();
    auto opened = session::Session::open(file.string() + ".yaml", options);
    ASSERT_TRUE(opened) << opened.error().message;
    session::Session& session = **opened;
    session.run(std::atomic<bool>{false});
    const driver::Fault fault = session.device().fault();
    EXPECT_TRUE(fault == driver::Fault::kNone || fault == driver::Fault::kOverSpeed)
        << grip.name << ": " << driver::name(fault);
    EXPECT_GT(session.statistics().force_max(), 0.05) << "the scene was touched";
    EXPECT_EQ(session.device().heat().lowered(), 0u)
        << "heat must not limit the force in a shipped scene";
    EXPECT_GT(session.device().heat().max_heat(), 0);
  }
}

INSTANTIATE_TEST_SUITE_P(ByName, WatchedScene,
                         ::testing::Values("box", "charges", "clay", "clay_tablet",
                                           "floating_block", "held_block", "honey", "ice", "rubber",
                                           "sandpaper", "soft_coarse", "tin_can", "trampoline",
                                           "water_balloon"),
                         [](const auto& scene) { return std::string(scene.param); });

/// A plate of 800 N/m under a hand that presses at 0.1 m/s, with an arm file and separately set
/// motors.
class PressedPlate : public ::testing::TestWithParam<const char*> {
 protected:
  static std::unique_ptr<session::Session> open(bool reversed) {
    const auto folder = support::scratch_folder();
    const auto arm = std::filesystem::path(THIMBLE_SOURCE_DIR) / "app/arms" /
                     (std::string(GetParam()) + ".yaml");
    std::ofstream(folder / "plate.yaml")
        << "name: plate\narm: " << std::filesystem::relative(arm, folder).string()
        << "\nduration: 2\nobjects:\n  - {name: plate, plane: {normal: [0, 0, 1]}, stiffness: 800, "
           "damping: 0}\nhand:\n  path: [{t: 0, at: [0, 0, 0.01]}, {t: 0.5, at: [0, 0, 0.01]}, "
           "{t: 0.7, at: [0, 0, -0.01]}]\n";
    session::SessionOptions options;
    options.adjust = [reversed](scene::Scene& scene) {
      if (reversed) scene.arms.front().arm.simulated.firmware.wiring.motor_gain = {-1, -1, -1};
    };
    auto opened = session::Session::open(folder / "plate.yaml", options);
    if (!opened) {
      ADD_FAILURE() << opened.error().message;
      return nullptr;
    }
    return std::move(opened).value();
  }
};

TEST_P(PressedPlate, OnlyReversedMotorsAreSwitchedOff) {
  const auto sound = open(false);
  ASSERT_TRUE(sound);
  EXPECT_EQ(sound->run(std::atomic<bool>{false}), driver::ServoEnd::kDone);
  EXPECT_EQ(sound->device().fault(), driver::Fault::kNone);

  const auto reversed = open(true);
  ASSERT_TRUE(reversed);
  EXPECT_EQ(reversed->run(std::atomic<bool>{false}), driver::ServoEnd::kFault);
  EXPECT_EQ(driver::name(reversed->device().fault()), "motors_reversed");
  const driver::TickRecord& last = reversed->ticks().back();
  const double speed = std::hypot(last.v_WT[0], last.v_WT[1], last.v_WT[2]);
  std::printf("%-16s off at %.1f mm, %.2f m/s\n", GetParam(), -1e3 * last.p_WT[2], speed);
  EXPECT_GT(last.p_WT[2], -0.012);
  EXPECT_LT(speed, 0.7);
}

INSTANTIATE_TEST_SUITE_P(ByArm, PressedPlate,
                         ::testing::Values("vintage_phantom", "woodenhaptics", "polhem", "falcon"),
                         [](const auto& arm) { return std::string(arm.param); });

}  // namespace
}  // namespace thimble
