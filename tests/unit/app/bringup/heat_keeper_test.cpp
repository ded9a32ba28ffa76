#include "heat_keeper.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include "log/logger.h"
#include "support/scratch.h"
#include "thimble/scene/simulated_device.h"

namespace thimble::bringup {
namespace {

constexpr driver::HeatSettings kSettings{.continuous_current = {1, 1, 1},
                                         .time_constant = {60, 30, 120}};
constexpr std::array<double, 3> kHeat{0.9, 0.4, 0.7};
constexpr std::array<double, 3> kHot{1, 1, 1};
constexpr double kNow = 1.8e9;  // s since 1970

class HeatKeeperTest : public ::testing::Test {
 protected:
  HeatKeeperTest() { setenv("XDG_STATE_HOME", (support::scratch_folder() / "state").c_str(), 1); }
};

TEST_F(HeatKeeperTest, NewArmIsCold) {
  const scene::KnownHeat known = scene::load_heat("never", kSettings, kNow);
  EXPECT_EQ(known.heat, (std::array<double, 3>{}));
  EXPECT_EQ(known.note, "");
}

TEST_F(HeatKeeperTest, CoolsWithElapsedTime) {
  ASSERT_TRUE(scene::save_heat("arm/1", kHeat, kNow, false));
  const scene::KnownHeat known = scene::load_heat("arm/1", kSettings, kNow + 45);
  EXPECT_EQ(known.note, "");
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(known.heat[i], kHeat[i] * std::exp(-45 / kSettings.time_constant[i]), 1e-9);
  }
  EXPECT_EQ(scene::load_heat("arm_2", kSettings, kNow).heat[0], 0) << "each arm has its own file";
}

TEST_F(HeatKeeperTest, ClockThatStepsBackCoolsNothing) {
  ASSERT_TRUE(scene::save_heat("arm", kHeat, kNow, false));
  EXPECT_EQ(scene::load_heat("arm", kSettings, kNow - 86400).heat, kHeat);
}

TEST_F(HeatKeeperTest, UnfinishedRunIsTreatedAsHot) {
  ASSERT_TRUE(scene::save_heat("arm", kHeat, kNow, true));
  const scene::KnownHeat known = scene::load_heat("arm", kSettings, kNow + 5);
  EXPECT_EQ(known.heat, kHot);
  EXPECT_NE(known.note.find("did not end properly"), std::string::npos);
}

TEST_F(HeatKeeperTest, PipeIsTreatedAsHot) {
  ASSERT_TRUE(scene::save_heat("arm", kHeat, kNow, false));
  std::filesystem::remove(scene::heat_file("arm"));
  ASSERT_EQ(mkfifo(scene::heat_file("arm").c_str(), 0600), 0);
  const scene::KnownHeat known = scene::load_heat("arm", kSettings, kNow);
  EXPECT_EQ(known.heat, kHot);
  EXPECT_NE(known.note.find("is not a regular file"), std::string::npos);
  std::filesystem::remove(scene::heat_file("arm"));
}

TEST_F(HeatKeeperTest, PipeBesideFileIsReplaced) {
  ASSERT_TRUE(scene::save_heat("arm", kHeat, kNow, false));
  const std::string pipe = scene::heat_file("arm").string() + ".new";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_TRUE(scene::save_heat("arm", kHeat, kNow, false));
  EXPECT_EQ(scene::load_heat("arm", kSettings, kNow).heat, kHeat);
}

TEST_F(HeatKeeperTest, CorruptFileIsTreatedAsHot) {
  for (const char* text : {"", "heat: [0, 0, 0]\n", "heat: [0, 0]\ntime: 1\nrunning: \"no\"\n",
                           "heat: [.nan, 0, 0]\ntime: 1\nrunning: \"no\"\n",
                           "heat: [-1, 0, 0]\ntime: 1\nrunning: \"no\"\n", "\x01\x02{[",
                           "heat: [0, 0, 0]\ntime: .inf\nrunning: \"no\"\n"}) {
    ASSERT_TRUE(scene::save_heat("arm", kHeat, kNow, false));
    std::ofstream(scene::heat_file("arm")) << text;
    const scene::KnownHeat known = scene::load_heat("arm", kSettings, kNow);
    EXPECT_EQ(known.heat, kHot) << text;
    EXPECT_NE(known.note.find("is not a valid record"), std::string::npos) << text;
  }
}

TEST_F(HeatKeeperTest, WarnsOfEachRecordThatCannotBeSavedOnly) {
  const auto log = support::scratch_folder() / "heat.log";
  ASSERT_TRUE(scene::begin_log({.file = log}));
  const auto warnings = [&log] {
    std::ifstream lines(log);
    int count = 0;
    for (std::string line; std::getline(lines, line);) {
      count += line.find("Cannot save the motor temperatures") != std::string::npos ? 1 : 0;
    }
    return count;
  };
  auto arm = scene::SimulatedDevice::open("vintage_phantom", {{0.0, {0, 0, 0}}, {1.0, {0, 0, 0}}});
  ASSERT_TRUE(arm) << arm.error().message;
  { const scene::HeatKeeper keeper("kept", (*arm)->device()); }
  EXPECT_EQ(warnings(), 0);
  const auto occupied = support::scratch_folder() / "no_folder";
  std::ofstream(occupied) << "a file";
  setenv("XDG_STATE_HOME", occupied.c_str(), 1);
  auto keeper = std::make_unique<scene::HeatKeeper>("kept", (*arm)->device());
  EXPECT_EQ(warnings(), 1) << "at the start";
  keeper.reset();
  EXPECT_EQ(warnings(), 2) << "and at the end";
}

}  // namespace
}  // namespace thimble::bringup
