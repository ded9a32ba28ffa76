#include "thimble/scene/simulated_device.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "thimble/driver/device.h"
#include "thimble/scene/arm_file.h"
#include "thimble/scene/scene_file.h"
#include "thimble/scene/shipped_files.h"

namespace thimble {
namespace {

using driver::DeviceState;
using driver::ForceCommand;
using driver::TickRecord;
using scene::SimulatedDevice;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(LoadByName, ReadsTheNamedArmAndScene) {
  const auto arm = scene::load_arm("vintage_phantom");
  ASSERT_TRUE(arm) << arm.error().message;
  EXPECT_EQ(arm->name, "vintage_phantom");
  const auto touched = scene::load_scene("rubber");
  ASSERT_TRUE(touched) << touched.error().message;
  EXPECT_EQ(touched->file, *scene::find_scene("rubber"));
  // Another arm replaces that of the scene, also by name.
  const auto other = scene::load_scene("rubber", {.arm = "woodenhaptics"});
  ASSERT_TRUE(other) << other.error().message;
  EXPECT_EQ(other->arms.front().arm.name, "woodenhaptics");
  EXPECT_EQ(other->arms.front().own_arm_file, touched->arms.front().arm_file);
}

TEST(LoadByName, UnknownNameListsTheKnownOnes) {
  const auto arm = scene::load_arm("vintage_fantom");
  ASSERT_FALSE(arm);
  EXPECT_NE(arm.error().message.find("woodenhaptics"), std::string::npos) << arm.error().message;
  const auto touched = scene::load_scene("elefant");
  ASSERT_FALSE(touched);
  EXPECT_NE(touched.error().message.find("elephant"), std::string::npos) << touched.error().message;
  const auto other = scene::load_scene("rubber", {.arm = "vintage_fantom"});
  ASSERT_FALSE(other);
  EXPECT_NE(other.error().message.find("vintage_fantom"), std::string::npos);
}

std::unique_ptr<SimulatedDevice> open_pressed() {
  auto opened = SimulatedDevice::open(
      "vintage_phantom", {{0.0, {0, 0, 0.01}}, {0.5, {0, 0, -0.005}}, {2.0, {0, 0, -0.005}}});
  EXPECT_TRUE(opened) << opened.error().message;
  return opened ? std::move(opened).value() : nullptr;
}

/// Wall at z = 0, which stores the force that was sent.
struct Wall {
  ForceCommand operator()(const DeviceState& state) noexcept {
    ForceCommand command;
    if (state.p_WT.z() < 0) command.f_T_W.z() = -500 * state.p_WT.z();
    return command;
  }
  void operator()(const TickRecord& record) noexcept {
    ++ticks;
    last = record;
  }

  int ticks = 0;
  TickRecord last;
};

TEST(SimulatedDevice, SendsNoForceUntilItIsActivated) {
  const auto arm = open_pressed();
  ASSERT_NE(arm, nullptr);
  Wall wall;
  EXPECT_EQ(arm->run(1, wall, wall), driver::ServoEnd::kDone);
  EXPECT_EQ(wall.ticks, 1000);
  EXPECT_GT(wall.last.f_wanted_W[2], 1);
  EXPECT_EQ(wall.last.f_sent_W, (std::array<double, 3>{}));
  EXPECT_EQ(arm->simulation().currents(), Eigen::Vector3d(0, 0, 0));
}

TEST(SimulatedDevice, HoldsTheHandBehindAWallAsSoonAsItIsActive) {
  const auto arm = open_pressed();
  ASSERT_NE(arm, nullptr);
  ASSERT_TRUE(arm->device().activate());
  Wall wall;
  EXPECT_EQ(arm->run(1.5, wall, wall), driver::ServoEnd::kDone);
  // The springs of hand (300 N/m) and wall share 5 mm; the arm's dry friction is 0.04 N.
  EXPECT_NEAR(wall.last.f_sent_W[2], 0.005 * 300 * 500 / 800.0, 0.05);
  // The loop ends with zero force.
  EXPECT_EQ(arm->device().stage(), driver::DeviceStage::kIdle);
  EXPECT_EQ(arm->device().f_sent_W(), Eigen::Vector3d(0, 0, 0));
}

TEST(SimulatedDevice, HasTheGateOfItsArmFile) {
  const auto arm = open_pressed();
  ASSERT_NE(arm, nullptr);
  const driver::DeviceSettings settings = scene::device_settings(arm->arm(), 1000);
  EXPECT_EQ(settings.limits.force_max, 5);
  EXPECT_EQ(settings.energy.stage, driver::EnergyStage::kPassivity);
  EXPECT_GT(settings.energy.mass, 0);
  EXPECT_TRUE(settings.heat.named());
  EXPECT_EQ(settings.p_WB, arm->arm().p_WB);
  EXPECT_EQ(scene::device_settings(arm->arm(), 1000, driver::EnergyStage::kNone).energy.stage,
            driver::EnergyStage::kNone);
  ASSERT_TRUE(arm->device().activate());
  auto push = [](const DeviceState&) noexcept {
    return ForceCommand{.f_T_W = {0, 100, 0}, .touch = {}};
  };
  double most = 0;
  auto watch = [&](const TickRecord& record) noexcept {
    most = std::max(most, Eigen::Map<const Eigen::Vector3d>(record.f_sent_W.data()).norm());
  };
  arm->run(0.5, push, watch);
  EXPECT_GT(most, 1);
  EXPECT_LE(most, 5 * (1 + 1e-9));
}

TEST(SimulatedDevice, RejectsImpossibleRatesAndPaths) {
  for (const double rate : {kNaN, 0.0, -1000.0, 9.0, 1e6, kInfinity}) {
    EXPECT_FALSE(SimulatedDevice::open("vintage_phantom", {{0.0, {0, 0, 0}}}, {.rate = rate}));
  }
  const scene::HandRoute beyond{{0.0, {0, 0, 0}}, {0.25, {0, 0, 0.5}}};
  const auto far = SimulatedDevice::open("vintage_phantom", beyond);
  ASSERT_FALSE(far);
  EXPECT_NE(far.error().message.find("0.250 s"), std::string::npos) << far.error().message;
  EXPECT_FALSE(SimulatedDevice::open("vintage_phantom", {{0.0, {kNaN, 0, 0}}}));
  EXPECT_FALSE(SimulatedDevice::open("vintage_phantom", {{kNaN, {0, 0, 0}}}));
  EXPECT_FALSE(SimulatedDevice::open("vintage_phantom", scene::HandRoute()));
  EXPECT_FALSE(SimulatedDevice::open("vintage_phantom", {{0.5, {0, 0, 0}}, {0.0, {0, 0, 0.01}}}));
  EXPECT_FALSE(SimulatedDevice::open("nobody_s_arm", {{0.0, {0, 0, 0}}}));
}

TEST(SimulatedDevice, RunsNoTickInZeroTime) {
  const auto arm = open_pressed();
  ASSERT_NE(arm, nullptr);
  ASSERT_TRUE(arm->device().activate());
  Wall wall;
  for (const double seconds : {0.0, -1.0, kNaN}) {
    EXPECT_EQ(arm->run(seconds, wall, wall), driver::ServoEnd::kDone);
  }
  EXPECT_EQ(wall.ticks, 0);
}

}  // namespace
}  // namespace thimble
